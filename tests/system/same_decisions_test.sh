#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: same_decisions_test.sh ZONEPACK DATA ZONED...: one run, the same event log byte for byte from every
# build of zoned, with and without the processor's FMA, 20 times over.
set -euo pipefail
zonepack=$1 data=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run=$data/scenario1_loop
"$zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out "$work/map" >/dev/null 2>&1

hash_of() {  # ZONED
  "$1" replay --config config/agilex.yaml --map "$work/map" --can "$run/can0.log" \
    --corrections "$run/corrections.txt" --truth "$run/base_groundtruth.txt" --max-signatures 50 \
    --events "$work/events.jsonl" --json "$work/summary.json" >/dev/null
  local told measured
  told=$(jq -r .event_log_hash "$work/summary.json")
  measured=$(b2sum -l 256 "$work/events.jsonl" | cut -d' ' -f1)
  [ "$told" = "$measured" ] || { echo "$1: event_log_hash $told, but b2sum says $measured" >&2; return 1; }
  echo "$measured"
}

expected=$(hash_of "$1")
runs=1
check() {  # WHAT HASH
  [ "$2" = "$expected" ] || { echo "$1: event log $2, expected $expected"; exit 1; }
  runs=$((runs + 1))
}
for zoned in "$@"; do
  check "$zoned" "$(hash_of "$zoned")"
  no_fma=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable
  check "$zoned without FMA" "$(GLIBC_TUNABLES=glibc.cpu.hwcaps=$no_fma hash_of "$zoned")"
done
while ((runs < 20)); do check "$1, run $runs" "$(hash_of "$1")"; done
echo "$runs runs of $# builds, one event log: $expected"
