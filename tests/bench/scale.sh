#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: scale.sh BIN SOURCE [WORK [SIZE...]]: what grows with a map, from 100 zones and 10,000 signatures to 100,000 and
# 1,000,000, as a Markdown table. SIZE is ZONES:SIGNATURES. BIN holds zonepack and zoned of a release build; needs
# valgrind for the instructions of a cycle. The buildings are made by tests/support/large_building.py. The drive is the
# sample's, from the first corridor on, at the map's smallest budget. Progress goes to standard error.
set -euo pipefail
if [ $# -lt 2 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
bin=$(realpath "$1") source=$(realpath "$2")
work=${3:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${3:-}" ] || trap 'rm -rf "$work"' EXIT
sizes=("${@:4}")
[ ${#sizes[@]} -gt 0 ] || sizes=(100:10000 1000:10000 1000:100000 10000:100000 10000:1000000 100000:1000000)
start=2,6.5,0
head -n 4000 "$source/tests/data/scenario1_loop/can0.log" >"$work/drive.log"

# Runs a command; its seconds and its most resident MiB go to $seconds and $mib.
timed() {
  local out
  out=$(python3 -c '
import os, subprocess, sys, time
begin = time.monotonic()
done = subprocess.Popen(sys.argv[2:], stdout=open(sys.argv[1], "w"), stderr=subprocess.STDOUT)
_, status, usage = os.wait4(done.pid, 0)
print(f"{time.monotonic() - begin:.2f} {usage.ru_maxrss / 1024:.1f}")
sys.exit(os.waitstatus_to_exitcode(status))' "$work/log" "$@") || { cat "$work/log" >&2; exit 1; }
  read -r seconds mib <<<"$out"
}
kib() { echo "$1" | awk '{printf "%.0f", $1 / 1024}'; }

echo "| zones | signatures | database MiB | build s, MiB | packs MiB | manifest KiB | fixed KiB (a zone) | plan s, MiB | report s, MiB, page KiB | replay: start s, MiB | instructions of a cycle: mean, most |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
for size in "${sizes[@]}"; do
  zones=${size%:*} signatures=${size#*:}
  at=$work/$zones-$signatures
  echo "$zones zones, $signatures signatures" >&2
  [ -e "$at.geojson" ] ||
    python3 "$source/tests/support/large_building.py" "$zones" "$signatures" "$at.db" "$at.geojson"
  rm -rf "$at.map"
  timed "$bin/zonepack" build --db "$at.db" --zones "$at.geojson" --out "$at.map"
  build="$seconds, $mib"
  timed "$bin/zonepack" plan "$at.map" --json "$at.plan"
  plan="$seconds, $mib"
  budget=$(jq .smallest_budget_bytes "$at.plan") fixed=$(jq .fixed_bytes "$at.plan")
  timed "$bin/zonepack" report "$at.map" --out "$at.html"
  report="$seconds, $mib, $(kib "$(stat -c %s "$at.html")")"
  replay=("$bin/zoned" replay --config "$source/config/agilex.yaml" --map "$at.map" --start "$start" --budget "$budget")
  head -n 40 "$work/drive.log" >"$work/short.log"
  timed "${replay[@]}" --can "$work/short.log"
  first="$seconds, $mib"
  instructions=-
  if command -v valgrind >/dev/null; then
    valgrind --tool=callgrind --callgrind-out-file="$work/dumps" --combine-dumps=yes --collect-atstart=no \
      --toggle-collect='zonepack::Cycle::run(zonepack::CycleInput const&)' \
      --dump-after='zonepack::Cycle::run(zonepack::CycleInput const&)' \
      "${replay[@]}" --can "$work/drive.log" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
    instructions=$(awk '/^totals:/ && $2 > 0 { n++; sum += $2; if ($2 > most) most = $2 }
                        END { printf "%d, %d", sum / n, most }' "$work/dumps")
    rm "$work/dumps"
  fi
  echo "| $zones | $signatures | $(($(stat -c %s "$at.db") >> 20)) | $build | $(($(du -sb "$at.map" | cut -f1) >> 20)) | $(kib "$(stat -c %s "$at.map/manifest.zpm")") | $(kib "$fixed") ($(awk -v f="$fixed" -v z="$zones" 'BEGIN { printf "%.0f", f / z }')) | $plan | $report | $first | $instructions |"
done
