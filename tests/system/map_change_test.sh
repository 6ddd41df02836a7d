#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: map_change_test.sh BIN SOURCE: SIGHUP takes another version of the map while the robot drives; whatever is
# wrong with it, the map in use stays. Recorded and replayed, the events are the same byte for byte.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/live_map.sh"

says() { grep -q -- "$1" out.txt || fail "no word of '$1'"; }
version() { "$bin/zonepack" inspect "$1" --json - 2>/dev/null | jq -r .version; }
budget() { "$bin/zonepack" plan "$1" --json - 2>/dev/null | jq .live_change_budget_bytes; }

build() { "$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
  --payload features,scan,grid "$@" >/dev/null 2>&1; }
build --out first
build --out second --max-zone-bytes 300KiB
[[ $(version first) != "$(version second)" ]] || fail "one version"
cp -r first map
drive $(($(budget first) > $(budget second) ? $(budget first) : $(budget second)))

in_use() { [[ $(jq -r .map_version status.json) == "$(version "$1")" ]] || fail "not $1 in use: $(cat status.json)"; }
put() { cp "$1" "map/.coming" && mv "map/.coming" "map/$(basename "$1")"; }  # as rsync does: by rename
refused() {  # COUNT WHAT-IS-SAID
  kill -HUP $pid
  until_status ".map_refusals == $1 and .map_changes == 0 and .map_ready"
  in_use first
  says "$2"
}

until_status .map_ready
in_use first
kill -HUP $pid  # nothing new
put second/manifest.zpm
only_new=$(comm -13 <(cd first && ls ./*.zpk) <(cd second && ls ./*.zpk) | sed -n 1p)
refused 1 "is not changed: zone"  # half copied: no new pack
says "not found"
head -c 1000 second/manifest.zpm >map/manifest.zpm.half && mv map/manifest.zpm.half map/manifest.zpm
refused 2 "map/manifest.zpm"
for pack in second/*.zpk; do [ -e "map/$(basename "$pack")" ] || put "$pack"; done
put second/manifest.zpm
size=$(stat -c %s "map/$only_new")
truncate -s $((size - 1)) "map/$only_new"
refused 3 "${only_new#./}"
put "second/$only_new"
says "is the version that is in use"

kill -HUP $pid
until_status ".map_changes == 1 and .map_serial > 1 and .map_ready and .zones == $(ls second/*.zpk | wc -l)"
in_use second
until_status ".zones_loaded > 0 and .zones_resident > 1"
for _ in $(seq 100); do  # the newest block is written after a second
  "$bin/zonectl" dump flight.rec >ctl.txt 2>&1
  "$bin/zoned" replay --recording flight.rec --events flight.jsonl >ctl.txt 2>&1 || fail "flight: $(cat ctl.txt)"
  grep -q map_changed flight.jsonl && break
  sleep 0.1
done
grep -q map_changed flight.jsonl || fail "no change in the flight recorder: $(cat ctl.txt)"

put first/manifest.zpm  # and back
kill -HUP $pid
until_status ".map_changes == 2 and .map_ready and .zones == $(ls first/*.zpk | wc -l)"
in_use first
arrive
holds live.json '.minor_faults == 0 and .major_faults == 0'
words() { jq -r "select(.event | startswith(\"map_\")) | [.event, .reason] | join(\" \")" "$1" | tr '\n' ';'; }
[[ $(words live.jsonl) == "map_offered ;map_refused not found;map_offered ;map_refused "*";map_offered ;map_refused \
truncated;map_offered ;map_changed ;map_offered ;map_changed ;" ]] || fail "other events: $(words live.jsonl)"
echo "the map changes while the robot drives, or stays"
