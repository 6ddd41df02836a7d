#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: recording_equality.sh BIN SOURCE [RUNS]: live runs, recorded and replayed, give the same events byte for byte.
# Budgets, speeds and storage differ from run to run, so that loads end at other moments, fail, and are cancelled.
set -euo pipefail
bin=$1 source=$2 runs=${3:-10}
data=$source/tests/data config=$source/config/agilex.yaml
mission=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/zoned.sock

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
cp -r map damaged
rm damaged/H2-*.zpk
smallest=$("$bin/zonepack" plan map --json - 2>/dev/null | jq .smallest_budget_bytes)

speeds=(50 200 1000 1000000)
differ=0
printf '%4s %8s %12s %8s %8s %8s %10s  %s\n' run speed budget loads failed cancel bytes events
for ((run = 1; run <= runs; run++)); do
  speed=${speeds[run % ${#speeds[@]}]}
  budget=$((smallest + run % 3 * 300000))
  map=map
  ((run % 5 != 0)) || map=damaged
  "$bin/zoned" run --config "$config" --map $map --can "log:$mission/can0.log@$speed" --budget $budget \
    --corrections "$mission/corrections.txt" "${privilege[@]}" --record run.zpr --events live.jsonl \
    --json live.json >out.txt 2>&1 || { cat out.txt; exit 1; }
  "$bin/zoned" replay --recording run.zpr --events again.jsonl --json again.json >out.txt 2>&1 ||
    { cat out.txt; exit 1; }
  verdict=equal
  cmp -s live.jsonl again.jsonl || { verdict=DIFFERENT; differ=1; }
  count() { grep -c "\"event\":\"$1\"" live.jsonl || true; }
  printf '%4d %8s %12d %8d %8d %8d %10d  %s\n' $run $speed $budget "$(count load_done)" "$(count load_failed)" \
    "$(count load_cancelled)" "$(stat -c %s run.zpr)" $verdict
done
((differ == 0)) || { echo "a replay differs from its run"; exit 1; }
echo "$runs live runs, each replayed to the same events byte for byte"
