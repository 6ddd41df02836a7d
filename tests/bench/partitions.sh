#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: partitions.sh BIN SOURCE DATA [WORK]: drawn, suggested and geometric zones of one building, as a Markdown table:
# what three missions load and unload at each map's smallest budget, at 6.72 MiB and at 10 MiB.
#
# BIN holds zonepack and zoned, DATA holds hospital.db, zones.geojson and the missions scenario1_loop,
# scenario2_roundtrip and dayshift. Nobody touches the zones between the database and the replay. A cell gives zones
# loaded, MiB loaded and, where there are any, seconds without the robot's own zone in memory; "-" where the budget is
# below the map's smallest. Progress goes to standard error. With WORK, its partitions.svg shows the first mission.
set -euo pipefail
if [ $# -lt 3 ] || [ $# -gt 4 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
bin=$(realpath "$1") source=$(realpath "$2") data=$(realpath "$3")
work=${4:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${4:-}" ] || trap 'rm -rf "$work"' EXIT
missions=(scenario1_loop scenario2_roundtrip dayshift)

# NAME METHOD OPTION...
zones_of() {
  local name=$1 method=$2
  shift 2
  [ -e "$work/$name.geojson" ] && return
  if [ "$method" = drawn ]; then
    cp "$data/zones.geojson" "$work/$name.geojson"
  else
    "$bin/zonepack" suggest-zones --db "$data/hospital.db" --method "$method" --out "$work/$name.geojson" \
      --preview "$work/$name.png" "$@" >"$work/$name.txt"
  fi
}

replay() {  # NAME MISSION BUDGET LABEL
  local run=$data/$2 out=$work/$1-$2-$4.json
  "$bin/zoned" replay --config "$source/config/agilex.yaml" --map "$work/$1" --can "$run/can0.log" \
    --corrections "$run/corrections.txt" --truth "$run/base_groundtruth.txt" --budget "$3" --json "$out" --events "${out%.json}.jsonl" \
    >/dev/null 2>"$work/$1-$2-$4.txt" || return 0
}

cell() {  # NAME MISSION LABEL
  local json=$work/$1-$2-$3.json
  [ -s "$json" ] || { printf ' -'; return; }
  jq -j '" \(.zones_loaded) / \(.zones_unloaded), \(.bytes_loaded / 1048576 * 10 | round / 10)" +
         (if .zone_absent_s > 0 then " (\(.zone_absent_s * 10 | round / 10) s absent)" else "" end)' "$json"
}

names=()
row() { names+=("$1"); zones_of "$@"; }
row drawn drawn
row suggested basins
row suggested-15m basins --max-length 15
row suggested-3MiB basins --max-zone-bytes 3MiB
row grid-5m grid:5m
row grid-10m grid:10m
row path-10m path:10m
row path-20m path:20m
row count-50 count:50

mib() { printf '%.2f' "$(jq -n "$1 / 1048576")"; }
printf '| zones | how many | largest, MiB | smallest budget, MiB |'
for mission in "${missions[@]}"; do
  for label in smallest 6.72MiB 10MiB; do printf ' %s, %s |' "$mission" "$label"; done
done
printf '\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n'
for name in "${names[@]}"; do
  echo "[$(date +%T)] $name" >&2
  [ -e "$work/$name/manifest.zpm" ] ||
    "$bin/zonepack" build --db "$data/hospital.db" --zones "$work/$name.geojson" --out "$work/$name" \
      --payload features,scan,grid --json "$work/$name-build.json" >/dev/null 2>"$work/$name-build.txt"
  "$bin/zonepack" plan "$work/$name" --json - >"$work/$name-plan.json" 2>/dev/null
  smallest=$(jq .smallest_budget_bytes "$work/$name-plan.json")
  largest=$(jq '[.zones[].charged_bytes] | max' "$work/$name-plan.json")
  printf '| %s | %s | %s | %s |' "$name" "$(jq '.zones | length' "$work/$name-plan.json")" "$(mib "$largest")" "$(mib "$smallest")"
  for mission in "${missions[@]}"; do
    replay "$name" "$mission" "$smallest" smallest
    replay "$name" "$mission" 6.72MiB 6.72MiB
    replay "$name" "$mission" 10MiB 10MiB
    for label in smallest 6.72MiB 10MiB; do cell "$name" "$mission" "$label"; printf ' |'; done
  done
  printf '\n'
done
python3 "$(dirname "${BASH_SOURCE[0]}")/partition_picture.py" "$work" "$data/${missions[0]}/base_groundtruth.txt" "$work/partitions.svg"
