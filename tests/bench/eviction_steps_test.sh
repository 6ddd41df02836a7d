#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Evicting takes the same number of instructions for zones of 1 and of 10,000 slots, with 10 and 100,000
# zones known. Usage: eviction_steps_test.sh PROGRAM
set -euo pipefail
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

instructions() {  # SLOTS ZONES
  valgrind --tool=callgrind --callgrind-out-file="$work/out" --collect-atstart=no \
    --toggle-collect='measured(*)' "$program" "$1" "$2" 100 >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; exit 1; }
  sed -n 's/^summary: //p' "$work/out"
}

first=
for slots in 1 10000; do
  for zones in 10 100000; do
    count=$(instructions "$slots" "$zones")
    echo "$slots slots, $zones zones: $count instructions for 100 evictions"
    if ((count == 0)); then echo "nothing was counted" >&2; exit 1; fi
    : "${first:=$count}"
    if [[ $count != "$first" ]]; then echo "not the same" >&2; exit 1; fi
  done
done
