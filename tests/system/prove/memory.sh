#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: memory.sh BIN SOURCE DB MISSION SPEED SECONDS: a mission driven live at plan's smallest budget inside a memory
# cgroup limited to budget + 12 MiB, caches dropped before: the kernel kills nothing and its limit is not hit, though
# ten programs read along, though a neighbour takes all memory that is left. At SPEED times its speed, and at its own
# for SECONDS (0: not). Then the limit is lowered until the run fails, which shows that it can.
# MISSION: a folder with can0.log and corrections.txt. Exit code 77 where the machine lets nobody limit memory.
set -euo pipefail
bin=$1 source=$2 db=$3 mission=$4 speed=$5 seconds=$6
. "$(dirname "$0")/lib.sh"
overhead=$((12 << 20)) spare=$((1 << 20)) neighbours=$((256 << 20))
work=$(mktemp -d)
cleanup() {
  local group
  jobs -p | xargs -r kill 2>/dev/null || true
  for group in "$work"/*/group; do
    [ ! -f "$group" ] || { remove_group "$(cat "$group")/robot"; remove_group "$(cat "$group")"; }
  done
  rm -rf "$work"
}
trap cleanup EXIT
find_memory_cgroups || { echo "memory: no memory cgroup here"; exit 77; }

# A neighbour in the same room for memory, which wants more than there is and is the first to be killed for it; its
# pages and files push against everything that can be pushed out. Again and again until it is told to stop.
take_all_memory() {  # ROOM
  local taker=0
  trap 'kill $taker 2>/dev/null; wait $taker 2>/dev/null; exit 0' TERM
  while :; do
    stress-ng --quiet --vm 1 --vm-bytes "$((2 * $1))" --vm-keep --oomable --temp-path "$work" &
    taker=$!
    wait $taker 2>/dev/null || true
    sleep 0.05
  done
}

# A run in a cgroup; all that is known of it goes to $work/NAME.
drive() {  # NAME LIMIT SPEED SECONDS alone|readers|neighbour
  local name=$1 limit=$2 at=$3 stop=$4 company=$5 pid watch code=0 companion=0
  local run=$work/$name group=$cgroup_base/zonepack-proof-$$-$1
  mkdir "$run"
  echo "$group" >"$run/group"
  make_group "$group" $((limit + neighbours)) && make_group "$group/robot" "$limit" ||
    { echo 77 >"$run/code"; return; }
  export ZONED_SOCKET=$run/zoned.sock STATE_DIRECTORY=$run/state
  mkdir "$run/state"
  if [ "$company" = neighbour ]; then
    (
      echo "$BASHPID" >"$group/cgroup.procs"
      echo 1000 >/proc/self/oom_score_adj
      take_all_memory $((limit + neighbours))
    ) >/dev/null 2>&1 &
    companion=$!
    sleep 1
  fi
  (
    echo "$BASHPID" >"$group/robot/cgroup.procs"
    exec "$work/zoned" run --config "$source/config/agilex.yaml" --map "$work/map" --budget "$budget" \
      --can "sim:$work/mission.yaml@$at" --corrections "$work/mission.txt" --json "$run/run.json"
  ) >"$run/out.txt" 2>&1 &
  pid=$!
  chrt -f 1 "$bin/memory_watch" $pid >"$run/watch.json" &
  watch=$!
  if [ "$company" = readers ]; then
    "$bin/map_readers" "$ZONED_SOCKET" 10 >"$run/readers.json" 2>"$run/readers.txt" &
    companion=$!
  fi
  if ((stop > 0)); then (sleep "$stop" && kill -TERM $pid 2>/dev/null) & fi
  wait $pid 2>/dev/null || code=$?  # the shell tells of a killed child there
  echo $code >"$run/code"
  wait $watch || true
  if [ "$company" = readers ]; then
    wait $companion || echo 1 >"$run/readers_failed"
  elif [ "$company" = neighbour ]; then
    limit_hits "$group" >"$run/neighbour_hits"
    kill -TERM $companion
    wait $companion || true
  fi
  cat "$group/robot/$peak_file" >"$run/peak"
  limit_hits "$group/robot" >"$run/hits"
  remove_group "$group/robot"
  remove_group "$group"
}

of() { jq -r "$2" "$work/$1"; }

row() {  # NAME
  local run=$work/$1 watched=$1/watch.json
  printf '%-22s %7.1f %8s %5s %8s %6s %6s %6s %6s %8s %5s\n' "$1" "$(of "$watched" .seconds)" \
    "$(mib "$(cat "$run/peak")")" "$(cat "$run/hits")" "$(of "$watched" .resident.samples)" \
    "$(mib "$(of "$watched" .resident.least)")" "$(mib "$(of "$watched" .resident.most)")" \
    "$(mib "$(of "$watched" .locked.least)")" "$(mib "$(of "$watched" .locked.most)")" \
    "$(mib "$(of "$watched" .share.most)")" "$(of "$watched" .share.samples)"
}

# What a run has beside its budget, in MiB: resident parts, and what the kernel charges that is not resident (files
# that are read, page tables, descriptors). Libraries that other programs use too may be charged to them.
breakdown() {  # NAME
  jq -r --argjson budget "$budget" --argjson charged "$(cat "$work/$1/peak")" '
    def mib: . / 1048576 * 100 | round / 100;
    .parts as $p |
    "parts, MiB: slots \($p.slots | mib) (budget \($budget | mib)), program \($p.program | mib), " +
    "libraries \($p.libraries | mib), heap with queues and tables \($p.heap | mib), stacks \($p.stacks | mib), " +
    "other with the ring for reading ahead \($p.other | mib); resident \([$p[]] | add | mib), charged \($charged | mib), " +
    "above the budget \($charged - $budget | mib)"' "$work/$1/watch.json"
}

judge() {  # NAME LIMIT
  local run=$work/$1 code
  code=$(cat "$run/code")
  ((code != 77)) || { echo "memory: cgroups cannot be made here"; exit 77; }
  ((code == 0)) || fail "$1: exit code $code: $(cat "$run/out.txt")"
  row "$1"
  (($(cat "$run/hits") == 0)) || fail "$1: the limit was hit $(cat "$run/hits") times"
  jq -e '.budget_violations == 0 and .minor_faults == 0 and .major_faults == 0 and .allocations == 0' \
    "$run/run.json" >/dev/null || fail "$1: $(cat "$run/run.json")"
  (($(cat "$run/peak") <= $2 - spare)) || fail "$1: $(cat "$run/peak") bytes, less than $spare below the limit of $2"
  jq -e ".most_resident_ever <= $resident and .share.most <= $2 and .locked.most <= $2" "$run/watch.json" >/dev/null ||
    fail "$1: more than the limit of $2 bytes, or than $resident resident: $(cat "$run/watch.json")"
  jq -e '.locked.least == .locked.most' "$run/watch.json" >/dev/null || fail "$1: locked memory is not constant"
  # The newest 256 looks are not counted: the process may be about to end.
  jq -e '.resident.samples + 256 >= 900 * .seconds and .share.samples >= 0.5 * .seconds - 1' "$run/watch.json" >/dev/null ||
    fail "$1: looked at less than 900 times a second: $(cat "$run/watch.json")"
  if [ -f "$run/readers.json" ]; then
    [ ! -f "$run/readers_failed" ] || fail "$1: $(cat "$run/readers.json" "$run/readers.txt")"
    printf '%-22s %s\n' "" "$(of "$1/readers.json" '"\(.readers) readers: \(.good) good reads, \(.expired) expired, \(.damaged) damaged, \(.leases) leases"')"
  fi
  if [ -f "$run/neighbour_hits" ]; then
    printf '%-22s the neighbour found no more memory %s times\n' "" "$(cat "$run/neighbour_hits")"
    (($(cat "$run/neighbour_hits") > 0)) || fail "$1: the neighbour never took all memory"
  fi
}

# Without the libraries zoned would pay for them in some drives and what watches it in others.
drop_all_but_libraries() {
  drop_caches
  read_libraries "$work/zoned"
}

strip -o "$work/zoned" "$bin/zoned"  # as it is installed: symbols would be read ahead, and charged
"$bin/zonepack" build --db "$db" --zones "$source/tests/data/zones.geojson" --out "$work/map" \
  --payload features,scan,grid >/dev/null 2>&1
budget=$("$bin/zonepack" plan "$work/map" --json - 2>/dev/null | jq .smallest_budget_bytes)
limit=$((budget + overhead)) resident=$((budget + (16 << 20)))  # the latter with libraries that others pay for
once=$(log_seconds "$mission")
repeat_mission "$mission" $((seconds / ${once%.*} + 1)) "$work/mission"

echo "budget (plan's smallest) $budget bytes, $(mib "$budget") MiB; limit (budget + 12 MiB) $limit bytes, $(mib $limit) MiB"
echo "MiB                    watched   charged  hits  looked   resident       locked   share  looked"
printf '%-22s %7s %8s %5s %8s %6s %6s %6s %6s %8s %5s\n' "" seconds most "" "1 kHz" least most least most most "1 Hz"
for company in alone readers neighbour; do
  drop_all_but_libraries
  drive "$company@$speed" $limit "$speed" 0 $company
  judge "$company@$speed" $limit
  [ $company != alone ] || breakdown "$company@$speed"
done
if ((seconds > 0)); then  # side by side: only memory is judged, and it is each one's own
  drop_all_but_libraries
  runs=()
  for company in alone readers neighbour; do drive "$company@1" $limit 1 "$seconds" $company & runs+=($!); done
  wait "${runs[@]}"
  for company in alone readers neighbour; do judge "$company@1" $limit; done
fi

drive_alone() {  # NAME LIMIT
  drop_all_but_libraries
  drive "$1" "$2" "$speed" 0 alone
}
drive_until_it_fails "$(cat "$work/alone@$speed/peak")" $((1 << 20)) 16 drive_alone
