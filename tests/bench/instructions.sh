#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: instructions.sh BIN SOURCE DB MISSION SPEED [CYCLES]: a mission is driven live and recorded, while readers take
# leases and zonectl pins; then the instructions of every cycle of the recording, or of the first CYCLES, are counted by
# callgrind, twice. Judged: the same numbers both times; at most 50,000 instructions at p99.99; the worst cycle obeys a
# bound made of each operation's worst call and of how many its settings allow; and that bound is under kMost. Exit code
# 77 without valgrind.
set -euo pipefail
bin=$1 source=$2 db=$3 mission=$4 speed=$5 cycles_wanted=${6:-}
kMost=2000000  # instructions: a fifth of the period of 10 ms at one instruction a nanosecond
command -v valgrind >/dev/null || { echo "instructions: no valgrind here"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "instructions: $*" >&2; exit 1; }
export ZONED_SOCKET=$work/zoned.sock

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
"$bin/zonepack" build --db "$db" --zones "$source/tests/data/zones.geojson" --out "$work/map" \
  --payload features,scan,grid >/dev/null 2>&1
budget=$("$bin/zonepack" plan "$work/map" --json - 2>/dev/null | jq .smallest_budget_bytes)
"$bin/zoned" run --config "$source/config/agilex.yaml" --map "$work/map" --budget "$budget" "${privilege[@]}" \
  --can "log:$mission/can0.log@$speed" --corrections "$mission/corrections.txt" --record "$work/run.zpr" \
  >"$work/out.txt" 2>&1 &
zoned=$!
"$bin/map_readers" "$ZONED_SOCKET" 2 >"$work/readers.txt" 2>&1 &
while kill -0 $zoned 2>/dev/null; do
  for command in pin unpin; do "$bin/zonectl" "$command" R11 >/dev/null 2>&1 || true; done
  sleep 0.05
done
wait $zoned || fail "$(cat "$work/out.txt")"

# Operations whose whole cost, with all they call, is told apart.
operations='WheelOdometry::take PoseFilter::predict PoseFilter::correct PoseFilter::estimate PoseFilter::drift_until
  ZoneKeeper::collect ZoneKeeper::pin ZoneKeeper::keep ZoneTracker::update Preload::update Residency::lease'

# A line a cycle: instructions, then calls and instructions of every operation.
count() {  # OUT INPUTS
  # A dump when a cycle is over. The dumps abbreviate names: "(7) name", from then on "(7)".
  # shellcheck disable=SC2086  # no argument where no number is wanted
  valgrind --tool=callgrind --callgrind-out-file="$work/dumps" --combine-dumps=yes --collect-atstart=no \
    --toggle-collect='measured(*)' --dump-after='zonepack::Cycle::run(zonepack::CycleInput const&)' \
    "$bin/recorded_cycles" "$work/run.zpr" $cycles_wanted >"$2" 2>"$work/log" || fail "$(cat "$work/log")"
  awk -v names="$operations" '
    BEGIN { n = split(names, name) }
    function operation_of(text,  id, i) {
      id = substr(text, 1, index(text, ")"))
      if (length(text) > length(id)) {
        known[id] = 0
        for (i = 1; i <= n; ++i) if (index(text, "zonepack::" name[i] "(")) known[id] = i
      }
      return known[id]
    }
    /^fn=/ { operation_of(substr($0, 4)); next }
    /^cfn=/ { callee = operation_of(substr($0, 5)); next }
    /^calls=/ {
      split($1, c, "=")
      getline
      if (callee) { calls[callee] += c[2]; cost[callee] += $2 }
      next
    }
    /^totals:/ {
      if ($2 <= 0) next
      printf "%d", $2
      for (i = 1; i <= n; ++i) { printf " %d %d", calls[i], cost[i]; calls[i] = cost[i] = 0 }
      print ""
    }' "$work/dumps" >"$1"
  rm "$work/dumps"
}

count "$work/first" "$work/inputs"
cycles=$(wc -l <"$work/inputs")
counted=$(wc -l <"$work/first")
((counted == cycles || counted == cycles + 1)) && ((cycles > 1000)) || fail "$counted of $cycles cycles were counted"
count "$work/again" "$work/inputs-again"
cmp "$work/first" "$work/again" || fail "another number of instructions in the second run"

# Without the noise of a shared machine: at one instruction a nanosecond or more, these are nanoseconds at most.
head -n "$cycles" "$work/first" | cut -d' ' -f1 | sort -n | awk '
  { sorted[NR] = $1 }
  function at(share) { return sorted[int(share * (NR - 1) + 1.5)] }
  END { printf "instructions of a cycle: p50 %d, p99 %d, p99.9 %d, p99.99 %d, most %d\n",
               at(0.5), at(0.99), at(0.999), at(0.9999), sorted[NR]
        exit at(0.9999) > 50000 }' || fail "p99.99 of a cycle is over 50,000 instructions"
paste -d' ' "$work/inputs" <(head -n "$cycles" "$work/first") | awk -v names="$operations" -v most="$kMost" '
  BEGIN {
    n = split(names, name)
    allowed["WheelOdometry::take"] = allowed["PoseFilter::predict"] = 64  # cycle.most_frames
    allowed["PoseFilter::correct"] = 16                                   # ControlLoop::kMostCorrections
    allowed["ZoneKeeper::pin"] = allowed["Residency::lease"] = 16          # Cycle::kMostCommands
  }
  {
    total = $7
    sum += total
    rest = total
    for (i = 1; i <= n; ++i) {
      calls = $(6 + 2 * i); cost = $(7 + 2 * i)
      all_calls[i] += calls; all_cost[i] += cost
      if (calls > most_calls[i]) most_calls[i] = calls
      if (calls > 0 && cost / calls > worst_call[i]) worst_call[i] = cost / calls
      if (cost > worst_in_cycle[i]) worst_in_cycle[i] = cost
      if (name[i] != "Residency::lease" && name[i] != "ZoneKeeper::pin") rest -= cost
    }
    if (rest > worst_rest) worst_rest = rest
    if (total > worst) { worst = total; line = $0; at = $1 }
    if (!least || total < least) least = total
  }
  END {
    printf "%d cycles: %d instructions in the mean, %d least, %d most\n", NR, sum / NR, least, worst
    printf "%-28s %9s %11s %11s %9s %11s %11s\n", "operation", "calls", "mean", "worst call", "allowed", "in bound", "worst cycle"
    split(line, w, " ")
    for (i = 1; i <= n; ++i) {
      times = name[i] in allowed ? allowed[name[i]] : (most_calls[i] ? most_calls[i] : 1)
      part = times * worst_call[i]
      bound += part
      if (w[7 + 2 * i] > sets_cost) { sets_cost = w[7 + 2 * i]; sets = name[i] }
      if (!all_calls[i]) { print "instructions: nothing is called " name[i] " any more, or the drive never does it"; lost = 1 }
      printf "%-28s %9d %11.0f %11.0f %9d %11.0f %11d\n", name[i], all_calls[i],
             all_calls[i] ? all_cost[i] / all_calls[i] : 0, worst_call[i], times, part, w[7 + 2 * i]
    }
    bound += worst_rest
    printf "%-28s %9s %11s %11.0f %9d %11.0f\n", "all else", "", "", worst_rest, 1, worst_rest
    printf "worst cycle %d: %d instructions; given %d frames, %d corrections, %d loads, %d commands; %d events; most of it: %s, %d\n",
           at, worst, w[2], w[3], w[4], w[5], w[6], sets, sets_cost
    printf "bound with all that a cycle may be given: %.0f instructions, of %d\n", bound, most
    exit lost || !(worst <= bound && bound <= most)
  }' || fail "a cycle is over its bound, or the bound over $kMost instructions"
echo "the same in both runs, cycle by cycle"
