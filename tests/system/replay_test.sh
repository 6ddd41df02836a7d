#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: replay_test.sh BIN SOURCE: the sample map, built and driven through scenario 1, keeps what it promises;
# damage and wrong use end as documented.
set -euo pipefail
bin=$1 data=$2/tests/data
run=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "$*" >&2; exit 1; }

replay() {  # MAP OPTION...
  local map=$1
  shift
  "$bin/zoned" replay --config "$config" --map "$map" --can "$can" \
    --corrections "$corrections" --truth "$run/base_groundtruth.txt" "$@"
}

holds() {  # FILE JQ-CONDITION
  jq -e "$2" "$1" >/dev/null || fail "$1 does not hold $2: $(cat "$1")"
}

exits() {  # CODE COMMAND...
  local want=$1 got=0
  shift
  "$@" >out.txt 2>&1 || got=$?
  ((got == want)) || fail "$*: exit code $got, not $want: $(cat out.txt)"
}

says() { grep -q -- "$1" out.txt || fail "no word of '$1' in: $(cat out.txt)"; }

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
exits 2 replay map --budget 12MB
exits 2 replay map --start here
exits 2 replay map --max-signatures many
exits 2 replay map --max-signatures -1
exits 2 replay map --no-such-option
exits 2 "$bin/zoned"
exits 2 "$bin/zoned" wander
says wander
exits 0 "$bin/zoned" replay --config "$config" --map map --can "$can"
says "nothing ever tells where the robot is"
says "first zone resident *never"
{ echo "nonsense"; head -2000 "$run/can0.log"; } >broken.log
can=broken.log exits 0 replay map --json broken.json
says "broken.log:1:"
holds broken.json '.can_rejected == 1 and .can_frames == 2000'
echo "scenario 1 keeps its promises"
