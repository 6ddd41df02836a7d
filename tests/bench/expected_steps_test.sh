#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A whole forecast and a choice by it take the same number of instructions in maps of 900 to 90,000 zones, of which 64 to
# 800 are held, and at most kMost. Usage: expected_steps_test.sh PROGRAM
set -euo pipefail
kMost=1000000  # a tenth of the period of 10 ms at one instruction a nanosecond
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
first=
printf '%8s %8s %14s\n' zones held instructions
for case in '30 64' '30 800' '300 64' '300 800'; do
  read -r side held <<<"$case"
  valgrind --tool=callgrind --callgrind-out-file="$work/out" --collect-atstart=no --toggle-collect='measured(*)' \
    "$program" "$side" "$held" 10 >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  count=$(sed -n 's/^summary: //p' "$work/out")
  printf '%8s %8s %14s\n' $((side * side)) "$held" $((count / 10))
  if ((count == 0)); then echo "nothing was counted" >&2; exit 1; fi
  : "${first:=$count}"
  if [[ $count != "$first" ]]; then echo "not the same" >&2; exit 1; fi
  if ((count / 10 > kMost)); then echo "over $kMost instructions" >&2; exit 1; fi
done
