#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: replay_test.sh BIN SOURCE: the sample map, built and driven through scenario 1, keeps what it promises;
# damage and wrong use end as documented.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/expect.sh"
bin=$1 data=$2/tests/data
run=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

replay() {  # MAP OPTION...
  local map=$1
  shift
  "$bin/zoned" replay --config "$config" --map "$map" --can "$can" \
    --corrections "$corrections" --truth "$run/base_groundtruth.txt" "$@"
}

config=$2/config/agilex.yaml can=$run/can0.log corrections=$run/corrections.txt
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1

# The numbers of scenario 1: LRU over the true zones, and never without the robot's own.
replay map --max-signatures 100 --json 100.json --events 100.jsonl >/dev/null
holds 100.json '.signatures_loaded == 82 and .signatures_unloaded == 0 and .peak_signatures <= 100'
holds 100.json '.zone_absent_s == 0 and .budget_violations == 0 and .wrong_zone_s == 0'
replay map --max-signatures 50 --json - >50.json
holds 50.json '.signatures_loaded <= 113 and .signatures_unloaded <= 64 and .peak_signatures <= 50'
holds 50.json '.zone_absent_s == 0 and .budget_violations == 0'

# The hash is that of the log's bytes, and every line is an object with the three first keys.
[[ $(jq -r .event_log_hash 100.json) == "$(b2sum -l 256 100.jsonl | cut -d' ' -f1)" ]] || fail "hash"
jq -es 'all(has("cycle") and has("t_ns") and has("event"))' 100.jsonl >/dev/null || fail "event log"

# The smallest budget is enough, one byte less than the largest zone is refused by name.
smallest=$("$bin/zonepack" plan map --json - 2>/dev/null | jq .smallest_budget_bytes)
replay map --budget "$smallest" --storage-rate 2000000 --json tight.json >/dev/null
holds tight.json ".budget_violations == 0 and .zone_absent_s == 0 and .peak_charged_bytes <= $smallest"
exits 1 replay map --budget 400KiB
says "zone L1"
says "$smallest"

# A damaged pack costs its zone: an event, a message, no more.
cp -r map damaged
pack=$(ls damaged/C2-*.zpk)
printf '\xff\xff\xff\xff\xff\xff\xff\xff' | dd of="$pack" bs=1 seek=5000 conv=notrunc status=none
exits 0 replay damaged --max-signatures 100 --json damaged.json --events damaged.jsonl
says "zone C2 cannot be loaded"
holds damaged.json '.signatures_loaded == 72 and .zone_absent_s > 10 and .budget_violations == 0'
grep -q '"event":"load_failed","zone":"C2".*"reason":"bad checksum"' damaged.jsonl || fail "no event"
truncate -s 100 "$pack"
exits 0 replay damaged
says "zone C2 cannot be loaded"
rm "$pack"
exits 0 replay damaged
says "not found"

# What cannot be read, and what was not meant.
exits 1 replay nowhere
says "manifest.zpm"
config=/nowhere.yaml exits 1 replay map
can=/nowhere.log exits 1 replay map
corrections=/nowhere.txt exits 1 replay map
exits 1 replay map --events /nowhere/at/all.jsonl
exits 2 replay map --budget 12Mb
exits 2 replay map --start here
exits 2 replay map --max-signatures many
exits 2 replay map --max-signatures -1
exits 2 replay map --no-such-option
exits 2 "$bin/zoned"
exits 2 "$bin/zoned" wander
says wander
exits 0 "$bin/zoned" replay --config "$config" --map map --can "$can"
says "nothing ever says where the robot is"
says "first zone resident *never"
{ echo "nonsense"; head -2000 "$run/can0.log"; } >broken.log
can=broken.log exits 0 replay map --json broken.json
says "broken.log:1:"
holds broken.json '.can_rejected == 1 and .can_frames == 2000'
# The robot's clock is set a minute into the drive, by seconds or by decades, forward or back, and the fixes are stamped
# by it: replay, log playback and calibration go on across it and come to what they come to without.
started=$(sed -n '1s/^(\([0-9.]*\)).*/\1/p' "$run/can0.log")
set_by() {  # SECONDS: set.log, set.txt
  awk -F'[()]' -v from="$started" -v by="$1" '{ t = $2 + 0; if (t - from >= 60) t += by; printf "(%.6f)%s\n", t, $3 }' \
    "$run/can0.log" >set.log
  awk -v from="$started" -v by="$1" '/^#/ { print; next }
    { for (i = 1; i <= 2; ++i) { t = $i + 0; if (t - from >= 60) t += by; $i = sprintf("%.6f", t) } print }' \
    "$run/corrections.txt" >set.txt
}
decisions() { grep -o '"event":"[a-z_]*","zone":"[^"]*"' "$1"; }
set_by 0
exits 0 "$bin/zoned" replay --config "$config" --map map --can set.log --corrections set.txt --events plain.jsonl
decisions plain.jsonl >plain.txt
for by in 1700000000 -1700000000 30 -20; do
  set_by "$by"
  exits 0 timeout 60 "$bin/zoned" replay --config "$config" --map map --can set.log --corrections set.txt --events set.jsonl
  says "set.log:[0-9]*: the clock of the log was set from 1718021660.[0-9]* s to "
  (($(grep -c 'the clock of the log was set' out.txt) == 1)) || fail "not said once: $(cat out.txt)"
  decisions set.jsonl | cmp - plain.txt || fail "a clock set by $by s changes what is decided"
  exits 0 timeout 60 "$bin/zoned" run --config "$config" --map map --can log:set.log@100000 --corrections set.txt \
    --allow-degraded --record-can captured.log
  says "the clock of the log was set"
  (($(wc -l <captured.log) == $(wc -l <set.log))) || fail "the recording lost frames"
done
# The true path was stamped by the same clock.
for by in 0 30; do
  set_by "$by"
  awk -v from="$started" -v by="$by" '/^#/ { print; next } { if ($1 - from >= 60) $1 = sprintf("%.6f", $1 + by); print }' \
    "$run/base_groundtruth.txt" >set_truth.txt
  exits 0 "$bin/zoned" calibrate --config "$config" --can set.log --truth set_truth.txt --json calibrated-$by.json
done
jq -e --slurpfile set calibrated-30.json '(.left - $set[0].left | fabs) < 0.001' calibrated-0.json >/dev/null ||
  fail "a clock set by 30 s changes what is calibrated: $(cat calibrated-0.json calibrated-30.json)"
says "the clock of the log was set"
echo "scenario 1 keeps its promises"
