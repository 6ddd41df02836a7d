#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: localizer_memory.sh BIN SOURCE DB MISSION SPEED [lost]: zoned at plan's smallest budget and zoneloc beside it,
# in one memory cgroup limited to budget + 12 MiB for zoned + 26 MiB for zoneloc: the kernel kills nothing, its limit is
# not hit, and zoneloc's own memory (what it maps of zoned's is zoned's) is at most 26 MiB, looked at 10 times a second.
# Then the same under less, until it fails, which shows that it can. lost: nothing says where the robot starts, so
# zoneloc searches the map, zone by zone.
# MISSION: a folder with can0.log, base_groundtruth.txt, calibration.yaml, rgb.txt and its images. They are read before,
# outside of the group: a camera's images come from no file. So are the libraries (read_libraries). Exit code 77 where
# nobody can limit memory, or without images.
set -euo pipefail
bin=$1 source=$2 db=$3 mission=$(realpath "$4") speed=$5 lost=${6:-}
. "$(dirname "$0")/lib.sh"
of_zoned=$((12 << 20)) of_zoneloc=$((26 << 20))
work=$(mktemp -d) group=
cleanup() {
  jobs -p | xargs -r kill 2>/dev/null || true
  [ -z "$group" ] || remove_group "$group"
  rm -rf "$work"
}
trap cleanup EXIT
[ -f "$mission/rgb.txt" ] || { echo "localizer_memory: $mission has no rgb.txt"; exit 77; }
find_memory_cgroups || { echo "localizer_memory: no memory cgroup here"; exit 77; }

# Where the mission starts, as --start takes it.
start=(--start "$(awk '!/^#/ { yaw = 2 * atan2($7, $8) * 180 / 3.14159265358979; printf "%s,%s,%.4f", $2, $3, yaw; exit }' \
  "$mission/base_groundtruth.txt")")
[ -z "$lost" ] || start=()

# Ten times a second until a process ends, a line: its own memory (heap, stacks, program, libraries), of that the files'
# (program, libraries), and all, in bytes.
watch_own() {  # PID FILE
  while awk '/^RssAnon/ { own = $2 } /^RssFile/ { files = $2 } /^VmRSS/ { all = $2 }
      END { if (!all) exit 1; print (own + files) * 1024, files * 1024, all * 1024 }' "/proc/$1/status" 2>/dev/null; do
    sleep 0.1
  done >"$2"
}

# Both programs in a group; fails where one of them does. All that is known goes to $work/NAME.
drive() {  # NAME LIMIT
  local run=$work/$1 zoned zoneloc watching code=0
  mkdir "$run" "$run/state"
  group=$cgroup_base/zonepack-localizer-$$-$1
  make_group "$group" "$2" || { echo "localizer_memory: cgroups cannot be made here"; exit 77; }
  export ZONED_SOCKET=$run/zoned.sock STATE_DIRECTORY=$run/state
  (
    echo "$BASHPID" >"$group/cgroup.procs"
    exec "$work/zoned" run --config "$source/config/agilex.yaml" --map "$work/map" --budget "$budget" "${start[@]}" \
      --can "log:$mission/can0.log@$speed" --quiet --json "$run/zoned.json"
  ) >"$run/zoned.txt" 2>&1 &
  zoned=$!
  for _ in $(seq 100); do [ -S "$ZONED_SOCKET" ] && break; sleep 0.02; done
  (
    echo "$BASHPID" >"$group/cgroup.procs"
    exec "$work/zoneloc" run --calibration "$mission/calibration.yaml" --camera "folder:$mission@$speed" \
      --json "$run/zoneloc.json"
  ) >"$run/zoneloc.txt" 2>&1 &
  zoneloc=$!
  watch_own $zoneloc "$run/own" &
  watching=$!
  wait $zoned 2>/dev/null || code=$?  # the shell reports a killed child there
  kill -TERM $zoneloc 2>/dev/null || true
  wait $zoneloc 2>/dev/null || code=$((code + $?))
  wait $watching || true
  echo $code >"$run/code"
  cat "$group/$peak_file" >"$run/peak"
  limit_hits "$group" >"$run/hits"
  remove_group "$group"
  group=
}

for program in zoned zoneloc; do strip -o "$work/$program" "$bin/$program"; done  # as they are installed
"$bin/zonepack" build --db "$db" --zones "$source/tests/data/zones.geojson" --out "$work/map" >/dev/null 2>&1
budget=$("$bin/zonepack" plan "$work/map" --json - 2>/dev/null | jq .smallest_budget_bytes)
limit=$((budget + of_zoned + of_zoneloc))
cat "$mission/can0.log" >/dev/null
read_libraries "$work"/{zoned,zoneloc}
awk -v folder="$mission" '!/^#/ && NF > 1 { print folder "/" $2 }' "$mission/rgb.txt" | xargs -d '\n' cat >/dev/null
drive together $limit
run=$work/together
[ "$(cat "$run/code")" = 0 ] || fail "exit code $(cat "$run/code"): $(cat "$run/zoned.txt" "$run/zoneloc.txt")"
looks=$(wc -l <"$run/own")
most() { awk -v k="$1" '$k > most { most = $k } END { print most }' "$run/own"; }
own=$(most 1) files=$(most 2) all=$(most 3)
images=$(jq .images "$run/zoneloc.json") fixes=$(jq .fixes_sent "$run/zoneloc.json")
echo "budget (plan's smallest) $(mib "$budget") MiB, limit (budget + 12 + 26 MiB) $(mib $limit) MiB, at $speed times its speed"
echo "charged to both at most $(mib "$(cat "$run/peak")") MiB, limit hit $(cat "$run/hits") times"
echo "zoneloc, $looks looks: at most $(mib "$own") MiB of its own, $(mib "$files") of files, $(mib "$all") with what it maps" \
  "of zoned's; $images images, $fixes fixes"
(($(cat "$run/hits") == 0)) || fail "the limit was hit $(cat "$run/hits") times"
((own <= of_zoneloc)) || fail "zoneloc took $own bytes of its own"
((fixes > 0)) || fail "no fix: this proves nothing of a localizer: $(cat "$run/zoneloc.json")"
jq -e '.budget_violations == 0' "$run/zoned.json" >/dev/null || fail "$(cat "$run/zoned.json")"
drive_until_it_fails "$(cat "$run/peak")" $((4 << 20)) 6 drive
