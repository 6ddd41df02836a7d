#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: tenant.sh BIN SOURCE DATA [WORK [MISSION [LIMIT_MIB...]]]: zoned and zoneloc beside a heavy tenant, as a language
# model is, in one memory cgroup, as a Markdown table: drawn zones, squares of 5 m, and the whole map in memory.
#
# BIN holds zonepack, zoned, zoneloc, tenant and recorded_fixes of a release build; DATA holds hospital.db, zones.geojson
# and MISSION (scenario1_loop), a folder with can0.log, base_groundtruth.txt, calibration.yaml, rgb.txt and its images.
# The tenant streams a file of 60 % of the limit through both cores and takes 15 % of it twice a second; when it is killed
# it starts again. The mission is driven at its own speed, else no deadline is judged: about two minutes a row. The first
# row of each map has no tenant and no limit, and "charged" is what the robot needs. The packs and the weights are not
# in memory when a run begins; images, programs and libraries are charged to nobody, as in system/prove/localizer_memory.sh.
# Exit code 77 where nobody can limit memory. Progress goes to standard error.
set -euo pipefail
if [ $# -lt 3 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
bin=$(realpath "$1") source=$(realpath "$2") data=$(realpath "$3")
. "$source/tests/system/prove/lib.sh"
mission=$data/${5:-scenario1_loop}
[ -f "$mission/rgb.txt" ] || { echo "tenant: $mission/rgb.txt is missing: a mission with images is expected" >&2; exit 1; }
for program in zonepack zoned zoneloc tenant recorded_fixes; do
  [ -x "$bin/$program" ] ||
    { echo "tenant: $bin/$program is missing: cmake --build --preset release --target $program" >&2; exit 1; }
done
find_memory_cgroups || { echo "tenant: no memory cgroup here"; exit 77; }
work=${4:-$(mktemp -d "${TMPDIR:-/var/tmp}/zonepack-XXXXXX")}  # on a disk: what lies in memory is never read
mkdir -p "$work"
work=$(realpath "$work")
limits=("${@:6}")
[ ${#limits[@]} -gt 0 ] || limits=(48 96)
group='' pressure=''
cleanup() {
  jobs -p | xargs -r kill 2>/dev/null || true
  wait
  leave
  [ -n "${4:-}" ] || rm -rf "$work"
}
start=$(awk '!/^#/ { yaw = 2 * atan2($7, $8) * 180 / 3.14159265358979; printf "%s,%s,%.4f", $2, $3, yaw; exit }' \
  "$mission/base_groundtruth.txt")

# One limit for all; the robot and the tenant have a group each below it, which has none. Where the kernel keeps pressure
# in another tree than memory, the robot has a group there too.
join() {  # LIMIT_MIB, 0: none
  local limit=$(($1 > 0 ? $1 << 20 : 1 << 40))
  group=$cgroup_base/zonepack-tenant-$$
  make_group "$group" $limit && make_group "$group/robot" $((1 << 40)) && make_group "$group/tenant" $((1 << 40)) ||
    { echo "tenant: cgroups cannot be made here"; exit 77; }
  pressure=$group/robot
  if [ ! -f "$pressure/memory.pressure" ]; then
    pressure=$(dirname "$cgroup_base")/unified/zonepack-tenant-$$
    mkdir "$pressure" 2>/dev/null || pressure=
  fi
}
leave() {
  [ -n "$group" ] || return 0
  [ -z "$pressure" ] || remove_group "$pressure"
  for part in "$group/robot" "$group/tenant" "$group"; do remove_group "$part"; done
  group=''
}
stalled_us() { sed -n 's/^some .*total=//p' "$pressure/memory.pressure" 2>/dev/null || true; }
forget() { for file in "$@"; do dd if="$file" iflag=nocache count=0 status=none; done; }  # its pages leave memory

# The tenant until it is told to stop, started again whenever the kernel kills it: its lines and kills go to RUN.
keep_tenant() {  # RUN LIMIT_MIB SECONDS
  local code=0 child=0
  trap 'kill $child 2>/dev/null; wait $child 2>/dev/null; exit 0' TERM
  while :; do
    (
      echo "$BASHPID" >"$group/tenant/cgroup.procs"
      echo 500 >/proc/self/oom_score_adj
      exec "$bin/tenant" "$work/weights-$2" "$3" $(($2 * 1048576 * 15 / 100)) mmap
    ) >>"$1/tenant.txt" 2>>"$1/tenant.err" &
    child=$!
    wait $child 2>/dev/null && return 0
    echo killed >>"$1/tenant.kills"
    sleep 0.5
  done
}

# What the robot's programs do, in RUN: their own files, exit codes, seconds, hits of the limit, stalls.
drive() {  # RUN MAP BUDGET LIMIT_MIB
  local run=$work/$1 zoned zoneloc code=0 tenant=''
  rm -rf "$run" && mkdir -p "$run/state"
  forget "$work/$2"/* "$work"/weights-*
  join "$4"
  if (($4 > 0)); then
    keep_tenant "$run" "$4" 100000 &
    tenant=$!
    sleep 3  # it has filled what there is
  fi
  export ZONED_SOCKET=$run/zoned.sock STATE_DIRECTORY=$run/state
  local begun=${EPOCHREALTIME/./} stalled
  stalled=$(stalled_us)
  in_robot 0 "$work/zoned" run --config "$source/config/agilex.yaml" --map "$work/$2" --budget "$3" --start "$start" \
    --can "log:$mission/can0.log@1" --quiet --json "$run/zoned.json" --events "$run/events.jsonl" \
    --record "$run/run.zpr" >"$run/zoned.txt" 2>&1 &
  zoned=$!
  for _ in $(seq 250); do [ -S "$ZONED_SOCKET" ] && break; sleep 0.02; done
  in_robot 250 "$work/zoneloc" run --calibration "$mission/calibration.yaml" --camera "folder:$mission@1" \
    --json "$run/zoneloc.json" >"$run/zoneloc.txt" 2>&1 &
  zoneloc=$!
  wait $zoned 2>/dev/null || code=$?
  echo "zoned_code=$code seconds=$(((${EPOCHREALTIME/./} - begun) / 1000))e-3" >"$run/facts"
  echo "stalled_us=$(($(stalled_us) - stalled))" >>"$run/facts" 2>/dev/null || true
  code=0
  kill -TERM $zoneloc 2>/dev/null || true
  wait $zoneloc 2>/dev/null || code=$?
  [ -z "$tenant" ] || { kill -TERM $tenant; wait $tenant || true; }
  echo "zoneloc_code=$code hits=$(limit_hits "$group") peak=$(cat "$group/$peak_file")" >>"$run/facts"
  leave
  "$bin/recorded_fixes" "$run/run.zpr" >"$run/fixes.txt" 2>"$run/fixes.err" || true
}
# Who is killed first is as their service units have it, all 500 higher: zoned -500, zoneloc -250, others 0. Lowering needs
# a privilege.
in_robot() {  # OOM_SCORE COMMAND...
  echo "$BASHPID" >"$group/robot/cgroup.procs"
  [ "$pressure" = "$group/robot" ] || [ -z "$pressure" ] || echo "$BASHPID" >"$pressure/cgroup.procs"
  echo "$1" >/proc/self/oom_score_adj
  shift
  exec "$@"
}

tenant_alone() {  # LIMIT_MIB
  local run=$work/alone-$1
  rm -rf "$run" && mkdir "$run"
  forget "$work/weights-$1"
  join "$1"
  keep_tenant "$run" "$1" 20
  leave
}

row() {  # NAME RUN MAP BUDGET LIMIT_MIB
  echo "[$(date +%T)] $1, limit $5 MiB" >&2
  drive "$2" "$3" "$4" "$5"
  python3 "$source/tests/bench/tenant_row.py" "$1, $(mib "$4") MiB" "$work/$2" "$mission/base_groundtruth.txt" "$5" \
    "$work/${2%-*}-0" "$work/alone-$5"
}

trap 'cleanup "$@"' EXIT
for program in zoned zoneloc; do strip -o "$work/$program" "$bin/$program"; done  # as they are installed
cp "$data/zones.geojson" "$work/drawn.geojson"
"$bin/zonepack" suggest-zones --db "$data/hospital.db" --method grid:5m --out "$work/squares.geojson" >"$work/squares.txt"
for map in drawn squares; do
  [ -e "$work/$map/manifest.zpm" ] || "$bin/zonepack" build --db "$data/hospital.db" --zones "$work/$map.geojson" \
    --out "$work/$map" --payload features,scan,grid >/dev/null 2>"$work/$map.txt"
  "$bin/zonepack" plan "$work/$map" --json "$work/$map.plan" >/dev/null
done
drawn=$(jq .smallest_budget_bytes "$work/drawn.plan") squares=$(jq .smallest_budget_bytes "$work/squares.plan")
whole=$(jq '.fixed_bytes + (([.zones[].charged_bytes] | add) / .slot_bytes | ceil) * (.slot_bytes + .table_bytes_per_slot)' \
  "$work/drawn.plan")
read_libraries "$work"/{zoned,zoneloc}
awk -v folder="$mission" '!/^#/ && NF > 1 { print folder "/" $2 }' "$mission/rgb.txt" | xargs -d '\n' cat >/dev/null
for limit in "${limits[@]}"; do
  head -c $((limit * 1048576 * 60 / 100)) /dev/urandom >"$work/weights-$limit"
  sync "$work/weights-$limit"
  tenant_alone "$limit"
done

python3 "$source/tests/bench/tenant_row.py"
for limit in 0 "${limits[@]}"; do
  row "drawn zones" "drawn-$limit" drawn "$drawn" "$limit"
  row "squares of 5 m" "squares-$limit" squares "$squares" "$limit"
  row "squares of 5 m" "wide-$limit" squares "$drawn" "$limit"
  row "whole map" "whole-$limit" drawn "$whole" "$limit"
done
