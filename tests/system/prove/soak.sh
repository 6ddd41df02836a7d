#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: soak.sh BIN SOURCE LAPS SPEED [SWITCHES]: the sample mission driven LAPS times through a building cut into
# squares of 0.7 m, so that zones are entered, loaded and evicted all the time, by the robot's own threads at SPEED times
# their speed; state and flight recorder are kept as on a robot, a reader reads along. Judged: at least SWITCHES zone
# switches; from the first third of the run to its end nothing grows (memory, locked memory, descriptors, threads, files);
# nothing is lost; and the counters are what the event log tells.
set -euo pipefail
bin=$1 source=$2 laps=$3 speed=$4 switches=${5:-1}
. "$(dirname "$0")/lib.sh"
mission=$source/tests/data/scenario1_loop
work=$(mktemp -d)
cleanup() {
  jobs -p | xargs -r kill 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
export ZONED_SOCKET=$work/zoned.sock STATE_DIRECTORY=$work/state
mkdir "$work/state"

# Squares along the way, and those around them.
awk -v size=0.7 '
  function floor(x) { return x < int(x) ? int(x) - 1 : int(x) }
  /^#/ { next }
  {
    x = floor($2 / size); y = floor($3 / size)
    for (i = -1; i <= 1; ++i) for (j = -1; j <= 1; ++j) squares[(x + i) " " (y + j)] = 1
  }
  END {
    printf "{\"type\": \"FeatureCollection\", \"features\": ["
    for (square in squares) {
      split(square, at, " ")
      l = at[1] * size; b = at[2] * size; r = (at[1] + 1) * size; t = (at[2] + 1) * size
      printf "%s{\"type\": \"Feature\", \"properties\": {\"name\": \"x%dy%d\", \"zone_type\": \"square\"}, \"geometry\": {\"type\": \"Polygon\", \"coordinates\": [[[%.1f, %.1f], [%.1f, %.1f], [%.1f, %.1f], [%.1f, %.1f], [%.1f, %.1f]]]}}",
             comma, at[1] + 100, at[2] + 100, l, b, r, b, r, t, l, t, l, b
      comma = ",\n"
    }
    print "]}"
  }' "$mission/base_groundtruth.txt" >"$work/squares.geojson"
"$bin/zonepack" build --db "$source/tests/data/hospital-small.db" --zones "$work/squares.geojson" --out "$work/map" \
  --payload features,scan,grid >"$work/out.txt" 2>&1 || fail "$(cat "$work/out.txt")"
# In squares so small, no place is as far from a wall as the robot otherwise must be to have gone through one.
# And the flight recorder soon goes round.
sed 's/^  wall_depth: 0.3 /  wall_depth: 0.05 /; s/^  bytes: 67108864 /  bytes: 2097152 /' "$source/config/agilex.yaml" >"$work/robot.yaml"
grep -q 'wall_depth: 0.05' "$work/robot.yaml" && grep -q 'bytes: 2097152' "$work/robot.yaml" ||
  fail "config/agilex.yaml has no wall_depth: 0.3, or no bytes: 67108864, to replace"
budget=$("$bin/zonepack" plan "$work/map" --json - 2>/dev/null | jq .smallest_budget_bytes)
repeat_mission "$mission" "$laps" "$work/drive"

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
"$bin/zoned" run --config "$work/robot.yaml" --map "$work/map" --budget "$budget" \
  --can "sim:$work/drive.yaml@$speed" --corrections "$work/drive.txt" "${privilege[@]}" \
  --events "$work/events.jsonl" --json "$work/run.json" >"$work/out.txt" 2>&1 &
zoned=$!
"$bin/map_readers" "$ZONED_SOCKET" 1 >"$work/readers.json" 2>&1 &
readers=$!

# Resident KiB, locked KiB, threads, descriptors, files, the flight recorder's segments; by the shell alone, which is quick.
look() {
  local key value rest resident= locked=
  while read -r key value rest; do
    case $key in
      VmRSS:) resident=$value ;;
      VmLck:) locked=$value ;;
    esac
  done 2>/dev/null <"/proc/$zoned/status" || return 1
  [ -n "$resident" ] || return 1
  local threads=("/proc/$zoned/task/"*) descriptors=("/proc/$zoned/fd/"*) files=("$work"/state/* "$work"/state/flight/*)
  local segments=("$work"/state/flight/segment-*)  # as many as the recorder's bytes allow, all open
  echo "$resident $locked ${#threads[@]} $((${#descriptors[@]} - ${#segments[@]})) $((${#files[@]} - ${#segments[@]})) ${#segments[@]}"
}
started=$SECONDS
sleep 0.3
while look >>"$work/looks.txt"; do sleep 0.1; done
code=0
wait $zoned || code=$?
((code == 0)) || fail "exit code $code: $(tail -5 "$work/out.txt")"
wait $readers || fail "the reader: $(cat "$work/readers.json")"

of() { jq "$1" "$work/run.json"; }
echo "$(of '.cycles') cycles, $(of '.cycles / 360000 * 100 | round / 100') hours of driving in $((SECONDS - started)) s; $(of .zone_switches) zone switches, $(of .zones_loaded) zones loaded, $(of .zones_unloaded) unloaded"
jq -r '"a reader beside: \(.good) good reads, \(.expired) expired, \(.damaged) damaged"' "$work/readers.json"

# The last look may find a process that is ending.
head -n -2 "$work/looks.txt" | awk '
  { for (i = 1; i <= NF; ++i) value[NR, i] = $i; n = NR; if (NF > columns) columns = NF }
  END {
    if (n < 9) { print "only " n + 0 " looks"; exit 1 }
    split("resident KiB,locked KiB,threads,descriptors,files of state,segments", name, ",")
    printf "%-18s %12s %12s %12s  (%d looks)\n", "", "first third", "second", "last", n
    for (i = 1; i <= columns; ++i) {
      # Of memory the most; of what is opened for a moment, a state that is being saved, the middle.
      for (third = 1; third <= 3; ++third) {
        split("", sorted)
        from = int((third - 1) * n / 3) + 1
        count = int(third * n / 3) - from + 1
        for (k = 0; k < count; ++k) {
          for (at = k; at > 0 && sorted[at - 1] > value[from + k, i]; --at) sorted[at] = sorted[at - 1]
          sorted[at] = value[from + k, i]
        }
        told[third] = sorted[i <= 2 ? count - 1 : int(count / 2)]
      }
      # Buffers of the threads that write and serve come with their first use.
      slack = i == 1 ? 512 : 0
      # Segments of the recorder: a ring of 8 and the one that replaces the oldest.
      grows = i == 6 ? told[3] > 9 : told[3] > told[1] + slack
      bad += grows
      printf "%-18s %12d %12d %12d%s\n", name[i], told[1], told[2], told[3], grows ? "  GROWS" : ""
    }
    exit bad > 0
  }' || fail "something grows"

jq -e ".zone_switches >= $switches and .budget_violations == 0 and .lost_events == 0 and .minor_faults == 0
  and .major_faults == 0 and .allocations == 0" "$work/run.json" >/dev/null || fail "$(cat "$work/run.json")"
[ "$(of .event_log_hash)" = "\"$(b2sum -l 256 "$work/events.jsonl" | cut -d' ' -f1)\"" ] || fail "another event log"

# Every counter again, from the events alone.
awk -F'[":,}]+' '
  function number(key,  i) { for (i = 2; i < NF; ++i) if ($i == key) return $(i + 1); return 0 }
  { event = ""; for (i = 2; i < NF; ++i) if ($i == "event") { event = $(i + 1); break } }
  event == "zone_entered" { if (entered++) ++switches }
  event == "load_done" { ++loaded; signatures_loaded += number("signatures"); resident[number("zone")] = 1 }
  event == "evicted" { ++unloaded; signatures_unloaded += number("signatures"); delete resident[number("zone")] }
  { charged = number("charged_bytes"); if (charged > most) most = charged }
  END {
    for (zone in resident) ++left
    printf "{\"zone_switches\": %d, \"zones_loaded\": %d, \"zones_unloaded\": %d, \"signatures_loaded\": %d, \"signatures_unloaded\": %d, \"left\": %d, \"most\": %d}\n",
           switches, loaded, unloaded, signatures_loaded, signatures_unloaded, left, most
  }' "$work/events.jsonl" >"$work/recount.json"
for counter in zone_switches zones_loaded zones_unloaded signatures_loaded signatures_unloaded; do
  counted=$(of .$counter) told=$(jq .$counter "$work/recount.json")
  printf '%-22s %10s counted, %10s in the event log\n' $counter "$counted" "$told"
  [ "$counted" = "$told" ] || fail "$counter: $counted counted, $told in the event log"
done
jq -e ".most <= $budget and .left == .zones_loaded - .zones_unloaded" "$work/recount.json" >/dev/null ||
  fail "the event log contradicts itself: $(cat "$work/recount.json"), budget $budget"
