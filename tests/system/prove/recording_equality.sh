#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: recording_equality.sh BIN SOURCE [RUNS]: live runs, recorded and replayed, give the same events byte for byte.
# Budgets, speeds and storage differ from run to run, so that loads end at other moments, fail, and are cancelled; all
# the while three readers take leases, and zonectl pins, unpins, freezes, hints routes and tells poses, right and wrong.
set -euo pipefail
bin=$1 source=$2 runs=${3:-10}
data=$source/tests/data config=$source/config/agilex.yaml
mission=$data/scenario1_loop
work=$(mktemp -d)
trap 'jobs -p | xargs -r kill 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/zoned.sock

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
cp -r map damaged
rm damaged/H2-*.zpk
sed 's/^  rate_limit: 0 /  rate_limit: 400000 /' "$config" >slow.yaml  # storage so slow that loads are given up
grep -q 'rate_limit: 400000' slow.yaml || { echo "$config has no rate_limit: 0 to replace"; exit 1; }
smallest=$("$bin/zonepack" plan map --json - 2>/dev/null | jq .smallest_budget_bytes)

# Commands of every kind, one after the other, until the run is over. Says how many were obeyed.
command_until_ended() {  # PID
  local zones=(R11 R12 R13 L1) obeyed=0 turn=0 zone command
  while kill -0 "$1" 2>/dev/null; do
    zone=${zones[turn++ % ${#zones[@]}]}
    for command in "pin $zone" freeze "pose 0.9 11 -149" "route L1 C3 --hint" unfreeze "unpin $zone" \
      "pose 3 3 90 0.05"; do
      # shellcheck disable=SC2086  # a command and its arguments
      if "$bin/zonectl" $command >/dev/null 2>&1; then obeyed=$((obeyed + 1)); fi
    done
  done
  echo $obeyed
}

speeds=(10 50 200 1000000)
differ=0 commands_all=0 leases_all=0 cancelled_all=0
printf '%4s %8s %12s %8s %8s %8s %8s %8s %8s %10s  %s\n' run speed budget loads failed cancel commands leases poses bytes events
enough() { ((commands_all > 0 && leases_all > 0 && cancelled_all > 0)); }
# A busy machine may starve the readers: then more runs, at most four times as many.
for ((run = 1; run <= 4 * runs; run++)); do
  if ((run > runs)) && enough; then break; fi
  speed=${speeds[run % ${#speeds[@]}]}
  budget=$((smallest + run % 3 * 300000))
  map=map
  ((run % 5 != 0)) || map=damaged
  settings=$config
  ((run % 2 != 0)) || settings=slow.yaml
  rm -f readers.json
  "$bin/zoned" run --config "$settings" --map $map --can "log:$mission/can0.log@$speed" --budget $budget \
    --corrections "$mission/corrections.txt" "${privilege[@]}" --record run.zpr --events live.jsonl \
    --json live.json >out.txt 2>&1 &
  zoned=$!
  "$bin/map_readers" "$ZONED_SOCKET" 3 >readers.json 2>/dev/null &
  readers=$!
  commands=$(command_until_ended $zoned)
  wait $zoned || { cat out.txt; exit 1; }
  kill $readers 2>/dev/null || true  # those that found no zoned in a run this short still look for it
  wait $readers || true
  "$bin/zoned" replay --recording run.zpr --events again.jsonl --json again.json >out.txt 2>&1 ||
    { cat out.txt; exit 1; }
  verdict=equal
  cmp -s live.jsonl again.jsonl || { verdict=DIFFERENT; differ=1; }
  count() { grep -c "\"event\":\"$1\"" live.jsonl || true; }
  leases=$(jq -s '.[0].leases // 0' readers.json 2>/dev/null || echo 0) cancelled=$(count load_cancelled)
  commands_all=$((commands_all + commands)) leases_all=$((leases_all + leases))
  cancelled_all=$((cancelled_all + cancelled))
  printf '%4d %8s %12d %8d %8d %8d %8d %8s %8d %10d  %s\n' "$run" "$speed" "$budget" "$(count load_done)" \
    "$(count load_failed)" "$cancelled" "$commands" "$leases" "$(count correction_rejected)" \
    "$(stat -c %s run.zpr)" $verdict
done
enough ||
  { echo "no command, lease or cancelled load in all these runs, so this proves too little"; exit 1; }
((differ == 0)) || { echo "a replay differs from its run"; exit 1; }
echo "$((run - 1)) live runs, each replayed to the same events byte for byte"
