#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: memory.sh BIN SOURCE DB MISSION SPEED: a mission driven live at plan's smallest budget inside a memory cgroup
# limited to budget + 16 MiB, caches dropped before: the kernel kills nothing and its limit is not hit. Then the limit
# is lowered until the run fails, which shows that it can. MISSION: a folder with can0.log and corrections.txt.
# Exit code 77 where the machine lets nobody limit memory.
set -euo pipefail
bin=$1 source=$2 db=$3 mission=$4 speed=$5
overhead=$((16 << 20))
work=$(mktemp -d)
group=
cleanup() {
  [ -z "$group" ] || rmdir "$group" 2>/dev/null || true
  rm -rf "$work"
}
trap cleanup EXIT
fail() { echo "memory: $*" >&2; exit 1; }

v1=/sys/fs/cgroup/memory v2=/sys/fs/cgroup
if [ -f $v1/memory.limit_in_bytes ]; then
  base=$v1 limit_file=memory.limit_in_bytes peak_file=memory.max_usage_in_bytes
elif grep -qw memory $v2/cgroup.controllers 2>/dev/null; then
  base=$v2 limit_file=memory.max peak_file=memory.peak
else
  echo "memory: no memory cgroup here"
  exit 77
fi

hits() {  # how often the limit was hit
  if [ $base = $v1 ]; then cat "$group/memory.failcnt"; else awk '$1 == "max" { print $2 }' "$group/memory.events"; fi
}

run() {  # LIMIT: the run's exit code in $code
  group=$base/zonepack-proof-$$
  mkdir "$group" 2>/dev/null || { echo "memory: cgroups cannot be made here"; exit 77; }
  echo "$1" >"$group/$limit_file"
  sync
  if [ -w /proc/sys/vm/drop_caches ]; then echo 3 >/proc/sys/vm/drop_caches; fi
  code=0
  (
    echo "$BASHPID" >"$group/cgroup.procs"
    exec "$bin/zoned" run --config "$source/config/agilex.yaml" --map "$work/map" --budget "$budget" \
      --can "log:$mission/can0.log@$speed" --corrections "$mission/corrections.txt" --json "$work/run.json"
  ) >"$work/out.txt" 2>&1 || code=$?
  peak=$(cat "$group/$peak_file") hit=$(hits)
  for _ in $(seq 50); do rmdir "$group" 2>/dev/null && break; sleep 0.1; done
  group=
}

export ZONED_SOCKET=$work/zoned.sock
"$bin/zonepack" build --db "$db" --zones "$source/tests/data/zones.geojson" --out "$work/map" \
  --payload features,scan,grid >/dev/null 2>&1
budget=$("$bin/zonepack" plan "$work/map" --json - 2>/dev/null | jq .smallest_budget_bytes)
limit=$((budget + overhead))
run $limit
printf 'memory: %-46s %12s bytes\n' "budget (plan's smallest)" "$budget" "limit (budget + 16 MiB)" "$limit" \
  "most charged, by the kernel" "$peak" "beside the budget" $((peak - budget))
((code == 0)) || fail "exit code $code: $(cat "$work/out.txt")"
((hit == 0)) || fail "the limit was hit $hit times"
jq -e '.budget_violations == 0 and .minor_faults == 0 and .major_faults == 0 and .allocations == 0' "$work/run.json" \
  >/dev/null || fail "$(cat "$work/run.json")"

lower=$peak
for _ in $(seq 12); do
  lower=$((lower - (1 << 20)))
  run $lower
  if ((code != 0 || hit > 0)); then
    printf 'memory: %-46s %12s bytes (exit code %s, limit hit %s times)\n' "fails under" "$lower" "$code" "$hit"
    exit 0
  fi
done
fail "the run does not fail under $lower bytes either, so this proves nothing"
