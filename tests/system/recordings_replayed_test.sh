#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: recordings_replayed_test.sh FOLDER ZONED...: each NAME.zpr there, replayed by every build of zoned, with and
# without the processor's FMA, gives NAME.jsonl, the events of the run it was recorded in, byte for byte.
set -euo pipefail
folder=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
no_fma=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable
replays=0
check() {  # RECORDING WHAT COMMAND...
  local recording=$1 what=$2
  shift 2
  "$@" replay --recording "$recording" --events "$work/events.jsonl" >"$work/out" 2>&1 || { cat "$work/out"; exit 1; }
  cmp "$work/events.jsonl" "${recording%.zpr}.jsonl" || { echo "$what: other events than ${recording##*/}'s run"; exit 1; }
  replays=$((replays + 1))
}
for recording in "$folder"/*.zpr; do
  [ -s "$recording" ] || { echo "no recording in $folder"; exit 1; }
  for zoned in "$@"; do
    check "$recording" "$zoned" "$zoned"
    check "$recording" "$zoned without FMA" env "GLIBC_TUNABLES=glibc.cpu.hwcaps=$no_fma" "$zoned"
  done
done
echo "$replays replays of what was recorded on the robot, the same events byte for byte"
