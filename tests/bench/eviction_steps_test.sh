#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Admitting a zone and evicting another for it takes the same number of instructions for zones of 1 to 10,000 slots,
# with 10 to 100,000 zones known, and 0 to 1,000 zones leased. Usage: eviction_steps_test.sh PROGRAM [--all]: with
# --all every combination, and the time beside; without, the corners.
set -euo pipefail
program=$1 all=${2:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

instructions() {  # SLOTS ZONES LEASES
  valgrind --tool=callgrind --callgrind-out-file="$work/out" --collect-atstart=no \
    --toggle-collect='measured(*)' "$program" "$@" 100 >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  sed -n 's/^summary: //p' "$work/out"
}

slots_list=(1 10000) zones_list=(10 100000) leases_list=(0 1000)
if [ "$all" = --all ]; then slots_list=(1 100 10000) zones_list=(10 1000 100000) leases_list=(0 8 500); fi
first=
printf '%8s %8s %8s %14s %10s\n' slots zones leases instructions ns
for slots in "${slots_list[@]}"; do
  for zones in "${zones_list[@]}"; do
    for leases in "${leases_list[@]}"; do
      if ((leases + 2 > zones)); then continue; fi
      count=$(instructions "$slots" "$zones" "$leases")
      time=
      if [ "$all" = --all ]; then time=$("$program" "$slots" "$zones" "$leases" 2000 | awk '{ print $3 }'); fi
      printf '%8s %8s %8s %14s %10s\n' "$slots" "$zones" "$leases" $((count / 100)) "$time"
      if ((count == 0)); then echo "nothing was counted" >&2; exit 1; fi
      : "${first:=$count}"
      if [[ $count != "$first" ]]; then echo "not the same" >&2; exit 1; fi
    done
  done
done
