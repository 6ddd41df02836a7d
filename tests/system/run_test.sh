#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: run_test.sh BIN SOURCE: the robot's own threads drive the sample map through scenario 1, played from its log.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/expect.sh"
bin=$1 data=$2/tests/data config=$2/config/agilex.yaml
run=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/run/zoned.sock

live() {  # MAP SPEED OPTION...
  local map=$1 speed=$2
  shift 2
  $how "$bin/zoned" run --config "$config" --map "$map" --can "log:$run/can0.log@$speed" \
    --corrections "$run/corrections.txt" --truth "$run/base_groundtruth.txt" "${privilege[@]}" "$@"
}

how= privilege=()
if ! chrt -f 1 true 2>/dev/null; then
  echo "no privilege for SCHED_FIFO here: run with --allow-degraded"
  privilege=(--allow-degraded)
fi
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
smallest=$("$bin/zonepack" plan map --json - 2>/dev/null | jq .smallest_budget_bytes)

live map 200 --budget "$smallest" --json live.json --events live.jsonl >out.txt 2>&1 || fail "$(cat out.txt)"
holds live.json ".budget_violations == 0 and .peak_charged_bytes <= $smallest and .cycles > 10000"
holds live.json '.minor_faults == 0 and .major_faults == 0 and .allocations == 0 and .lost_events == 0'
holds live.json '.process_peak_bytes > .overhead_bytes and .overhead_bytes > 0'
holds live.json '.missed_deadlines == 0 and (.cycle_us, .wakeup_us | has("p50") and has("p99") and has("p9999") and has("max"))'
[[ $(jq -r .event_log_hash live.json) == "$(b2sum -l 256 live.jsonl | cut -d' ' -f1)" ]] || fail "hash"

# The same cycle as in a replay: where the robot believes to be does not depend on how fast zones load.
"$bin/zoned" replay --config "$config" --map map --can "$run/can0.log" --corrections "$run/corrections.txt" \
  --truth "$run/base_groundtruth.txt" --budget "$smallest" --json replay.json --events replay.jsonl >out.txt
route='select(.event == "zone_entered") | [.cycle, .zone, .x_mm, .y_mm]'
cmp <(jq -c "$route" live.jsonl) <(jq -c "$route" replay.jsonl) || fail "another route than in the replay"
[[ $(jq .cycles live.json) == "$(jq .cycles replay.json)" ]] || fail "another number of cycles"

# What is recorded of the bus is the log that was played, and can-utils read it.
live map 200 --record-can recorded.log >out.txt 2>&1 || fail "$(cat out.txt)"
grep -v '^$' "$run/can0.log" | cut -d' ' -f1-3 | cmp - recorded.log || fail "another log than the one played"
log2asc -I recorded.log -O recorded.asc can0 || fail "log2asc does not read it"
[[ $(grep -c ' Rx ' recorded.asc) == "$(wc -l <recorded.log)" ]] || fail "log2asc leaves lines out"
exits 1 live map 1 --record-can /nowhere/can.log
says "/nowhere/can.log"

# A simulated bus whose controller leaves it for a second: said, and the pose is less sure meanwhile.
cat >bus.yaml <<EOF
log: $run/can0.log
bit_rate: 500000
queue: 64
traffic: [{id: 0x0A0, period: 0.002}]
faults: [{at: 20, for: 1, kind: bus_off}, {at: 30, for: 1, kind: down}, {at: 40, count: 3, kind: overflow}]
EOF
"$bin/zoned" run --config "$config" --map map --can sim:bus.yaml@20 --corrections "$run/corrections.txt" \
  "${privilege[@]}" --json simulated.json >out.txt 2>&1 || fail "$(cat out.txt)"
for word in bus-off restarted "can0: down" "can0: up" "3 frames lost"; do says "$word"; done
holds simulated.json '.can_frames > 50000 and .allocations == 0 and .minor_faults == 0'
echo "log: [" >bad.yaml
exits 1 "$bin/zoned" run --config "$config" --map map --can sim:bad.yaml
says "bad.yaml:"

# No bus: refused by name, with the command that mends it.
if [ ! -e /sys/class/net/nocan7 ]; then
  exits 1 "$bin/zoned" run --config "$config" --map map --can socketcan:nocan7
  says "ip link set nocan7 up type can"
  exits 1 "$bin/zoned" run --config "$config" --map map --can socketcan:nocan7 --check
  says "REFUSED  CAN bus"
fi

# Others look on and have their say while it runs; SIGTERM ends it in order, with its results.
how="exec" live map 1 --json stopped.json --events stopped.jsonl >out.txt 2>&1 &
pid=$!
for _ in $(seq 200); do
  "$bin/zonectl" status >/dev/null 2>&1 && break
  sleep 0.05
done
ctl() { "$bin/zonectl" "$@" >ctl.txt 2>&1 || fail "zonectl $*: exit code $?: $(cat ctl.txt)"; }
ctl status --json status.json
holds status.json '.budget_bytes > 0 and .cycles > 0'
ctl zones
(($(grep -c -E 'resident|absent|filling' ctl.txt) >= 24)) || fail "zones: $(cat ctl.txt)"
ctl metrics
grep -q '^zoned_map_ready' ctl.txt || fail "metrics: $(cat ctl.txt)"
ctl route L1 R52 --hint
ctl pose -4 -2 90
for _ in $(seq 100); do  # the first block of a recording is written after a second of cycles
  "$bin/zonectl" dump flight.rec >ctl.txt 2>&1 && break
  sleep 0.1
done
ctl dump flight.rec
"$bin/zoned" replay --recording flight.rec >ctl.txt 2>&1 || fail "replay of the dump: $(cat ctl.txt)"
"$bin/zonectl" pin attic >ctl.txt 2>&1 && fail "pinned a zone that does not exist"
kill -TERM $pid
wait $pid || fail "SIGTERM: exit code $?: $(cat out.txt)"
holds stopped.json '.cycles > 0 and .cycles < 10000'
tail -1 stopped.jsonl | grep -q '"event":"end"' || fail "no end of the event log"

# A damaged pack costs its zone.
cp -r map damaged
rm damaged/C2-*.zpk
exits 0 live damaged 200 --json damaged.json
says "zone C2 cannot be loaded"
holds damaged.json '.budget_violations == 0 and .signatures_loaded > 0'

exits 0 live map 1 --check
says "The run would start"
exits 1 live map 1 --check --budget 400KiB
says "REFUSED"

exits 1 live nowhere 1
says "manifest.zpm"
exits 1 live map 1 --budget 400KiB
says "$smallest"
exits 2 "$bin/zoned" run --config "$config" --map map --can can0
exits 2 "$bin/zoned" run --config "$config" --map map
exits 1 "$bin/zoned" run --config "$config" --map map --can log:/nowhere.log
says "/nowhere.log"
echo "the robot's threads keep what the replay promises"
