#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: tuned_zones.sh BIN SOURCE DATA [WORK]: zones tuned on the first two shifts of three robots, driven through on
# their last two, as a Markdown table.
#
# BIN holds zonepack and zoned, DATA holds hospital.db, zones.geojson and shifts/. For each budget the drawn zones and the
# tuned ones; "-" where the drawn ones do not fit. Progress goes to standard error.
set -euo pipefail
if [ $# -lt 3 ] || [ $# -gt 4 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
bin=$(realpath "$1") source=$(realpath "$2") data=$(realpath "$3")
work=${4:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${4:-}" ] || trap 'rm -rf "$work"' EXIT
seen=() unseen=()
for robot in pharmacy linen guide; do
  seen+=("$data/shifts/${robot}_1/base_groundtruth.txt" "$data/shifts/${robot}_2/base_groundtruth.txt")
  unseen+=("${robot}_3" "${robot}_4")
done
for shift in "${unseen[@]}"; do
  [ -e "$work/$shift.log" ] || xz -dc "$data/shifts/$shift/can0.log.xz" >"$work/$shift.log"
done

build() {  # ZONES MAP
  [ -e "$work/$2/manifest.zpm" ] ||
    "$bin/zonepack" build --db "$data/hospital.db" --zones "$1" --out "$work/$2" --payload features,scan,grid \
      >/dev/null 2>"$work/$2-build.txt"
}

row() {  # MAP BUDGET LABEL
  local shift smallest
  "$bin/zonepack" plan "$work/$1" --json - >"$work/$1-plan.json" 2>/dev/null
  smallest=$(jq '.smallest_budget_bytes / 1048576 * 100 | round / 100' "$work/$1-plan.json")
  printf '| %s | %s | %s | %s |' "$2" "$3" "$(jq '.zones | length' "$work/$1-plan.json")" "$smallest"
  for shift in "${unseen[@]}"; do
    "$bin/zoned" replay --config "$source/config/agilex.yaml" --map "$work/$1" --can "$work/$shift.log" \
      --corrections "$data/shifts/$shift/corrections.txt" --truth "$data/shifts/$shift/base_groundtruth.txt" \
      --budget "$2" --json "$work/$1-$2-$shift.json" >/dev/null 2>"$work/$1-$2-$shift.txt" || { printf ' - | - | - | - |\n'; return; }
  done
  for shift in "${unseen[@]}"; do cat "$work/$1-$2-$shift.json"; done | jq -rs '
    " \(map(.zones_loaded) | add) | \(map(.signatures_loaded) | add) | \((map(.bytes_loaded) | add) / 1048576 | round) | \(map(.zone_absent_s) | add) |"'
}

build "$data/zones.geojson" drawn
echo '| budget | zones | how many | smallest budget, MiB | zones loaded | signatures loaded | MiB read | zone absent, s |'
echo '|---|---|---|---|---|---|---|---|'
for budget in 10MiB 6.72MiB 4MiB 3MiB; do
  echo "[$(date +%T)] $budget" >&2
  "$bin/zonepack" tune "$work/drawn" --drives "${seen[@]}" --budget "$budget" --out "$work/tuned-$budget.geojson" \
    --preview "$work/tuned-$budget.html" --json "$work/tuned-$budget.json" >"$work/tuned-$budget.txt" 2>/dev/null
  build "$work/tuned-$budget.geojson" "tuned-$budget"
  row drawn "$budget" drawn
  row "tuned-$budget" "$budget" tuned
done
