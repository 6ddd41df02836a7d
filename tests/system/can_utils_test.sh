#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: can_utils_test.sh BIN SOURCE: what zoned reads and writes of CAN logs is what can-utils read and write.
set -euo pipefail
bin=$1 data=$2/tests/data config=$2/config/agilex.yaml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/run/zoned.sock

fail() { echo "$*" >&2; exit 1; }

here=(--start "0.8842,10.9826,-149.03")
replay() {  # LOG EVENTS SUMMARY
  "$bin/zoned" replay --config "$config" --map map --can "$1" "${here[@]}" --max-signatures 100 --events "$2" \
    --json "$3" >out.txt 2>&1 || fail "$1: $(cat out.txt)"
}
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1

# The drive, through log2asc and back through asc2log, which ends each line with the direction: the same decisions.
log=$data/scenario1_loop/can0.log
log2asc -I "$log" -O drive.asc can0 2>/dev/null
asc2log -I drive.asc -O back.log 2>/dev/null
grep -q ' R$' back.log || fail "asc2log writes no direction: $(head -3 back.log)"
replay "$log" here.jsonl here.json
replay back.log back.jsonl back.json
cmp here.jsonl back.jsonl || fail "other decisions after log2asc and asc2log"
jq -e '.signatures_loaded > 82 and .can_frames == 11046 and .can_rejected == 0' back.json >/dev/null ||
  fail "back.json: $(cat back.json)"

# Every kind of frame, as candump writes it, is recorded as it was played, and log2asc reads each.
cat >kinds.log <<'LOG'
(1718021600.001000) can0 311#000040DB00015BCF
(1718021600.002000) can0 12345678#0102030405060708
(1718021600.003000) can0 123#R
(1718021600.004000) can0 123#R4
(1718021600.005000) can0 311##1000040DB00015BCF0102030405060708
(1718021600.006000) can0 20000080#0000000000000000
(1718021600.007000) can0 7FF#
LOG
"$bin/zoned" run --config "$config" --map map --can log:kinds.log "${here[@]}" --record-can recorded.log \
  --allow-degraded --json run.json >out.txt 2>&1 || fail "$(cat out.txt)"
diff kinds.log recorded.log || fail "another log than the one played"
jq -e '.can_frames == 7' run.json >/dev/null || fail "run.json: $(cat run.json)"
log2asc -I recorded.log -O recorded.asc can0
[ "$(grep -cE ' (Rx|ErrorFrame)' recorded.asc)" = 7 ] || fail "log2asc leaves frames out: $(cat recorded.asc)"
asc2log -I recorded.asc 2>/dev/null | cut -d' ' -f3 | cmp - <(cut -d' ' -f3 kinds.log) ||
  fail "log2asc understood other frames"
echo "zoned and can-utils read each other's logs"
