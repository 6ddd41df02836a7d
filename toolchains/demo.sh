#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: toolchains/demo.sh BIN OUT: packs the sample hospital, replays scenario 1 in the smallest budget that will do,
# once with the fixes of another program and once with those that zoneloc finds in the camera's images, and writes into
# the folder OUT the map, plan.json, map.html, report.html, events.jsonl, summary.json, localizer.html, localizer.json,
# and scenario1.svg: the picture of README, whose copy in tests/data/readme a test compares with this one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=$1 out=$2 data=tests/data
run=$data/scenario1_loop

rm -rf "$out"
mkdir -p "$out"
echo "== pack: the sample hospital, 185 signatures mapped by RTAB-Map"
"$bin/zonepack" build --db $data/hospital-small.db --zones $data/zones.geojson --out "$out/map"
"$bin/zonepack" report "$out/map" --out "$out/map.html"
"$bin/zonepack" plan "$out/map" --json "$out/plan.json" >/dev/null
budget=$(jq .smallest_budget_bytes "$out/plan.json")
echo "== replay: scenario 1, a loop through five zones, in $budget bytes: the least that 'zonepack plan' allows"
"$bin/zoned" replay --config config/agilex.yaml --map "$out/map" --can $run/can0.log \
  --corrections $run/corrections.txt --truth $run/base_groundtruth.txt --budget "$budget" \
  --baseline $data/rtabmap_baseline/small_scenario1_loop_thr100_ret10_inittrue.csv \
  --events "$out/events.jsonl" --json "$out/summary.json" --report "$out/report.html" --picture "$out/scenario1.svg"
echo "== localize: the same drive in the same bytes, its pose from the camera and the rooms in memory alone"
"$bin/zoneloc" replay --config config/agilex.yaml --map "$out/map" --can $run/can0.log --images $run/rgb.txt \
  --calibration $run/calibration.yaml --truth $run/base_groundtruth.txt --start truth --budget "$budget" \
  --baseline $data/rtabmap_baseline/small_scenario1_loop_thr100_ret10_inittrue.csv \
  --json "$out/localizer.json" --report "$out/localizer.html"
