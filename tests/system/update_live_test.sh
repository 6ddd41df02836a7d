#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: update_live_test.sh BIN SOURCE: a robot takes an update of one zone while it drives: zones that did not change
# stay resident and are not read again. Recorded and replayed, the events are the same byte for byte.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/live_map.sh"

# A database of the same map in which the features of room R51 were found anew: their angles differ.
cp "$data/hospital-small.db" grown.db
chmod u+w grown.db
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map >/dev/null 2>&1
far=$("$bin/zonepack" export map --zone R51 2>/dev/null | jq -s 'map(.id) | join(",")' -r)
[ -n "$far" ] || fail "no signature in R51"
sqlite3 grown.db "update Feature set dir = dir + 1 where node_id in ($far)"
cp -r map before
most=$("$bin/zonepack" plan map --json - 2>/dev/null | jq '[.zones[].charged_bytes] | add * 2 + 4194304')

drive "$most"
until_status ".map_ready and .zones_resident > 1"
until_status ".zones_loading == 0 or (.zones_loading | not)"

"$bin/zonepack" update map --db grown.db --replace R51 --json update.json >/dev/null 2>&1
[[ $(jq -c '[.zones_changed, .zones_kept]' update.json) == '[["R51"],23]' ]] || fail "$(cat update.json)"
"$bin/zonepack" verify map >/dev/null || fail "the updated map is not whole"
[[ $("$bin/zonepack" diff before map --json - 2>/dev/null | jq -c '[.zones_changed, .fetch.pack_count]') == '[["R51"],1]' ]] ||
  fail "diff: $("$bin/zonepack" diff before map)"
for pack in before/*.zpk; do cmp "$pack" "map/$(basename "$pack")"; done
kill -HUP $pid
until_status ".map_changes == 1 and .map_ready"
sleep 1
arrive

# What was resident and did not change is kept: neither evicted at the change nor loaded after it.
jq -es '. as $all | (map(.event) | index("map_changed")) as $at
  | [$all[:$at][] | select(.event == "load_done" or .event == "evicted")] as $before
  | (reduce $before[] as $e ({}; .[$e.zone] = ($e.event == "load_done")) | to_entries | map(select(.value) | .key)) as $resident
  | [$all[$at:][] | select(.event == "zone_kept") | .zone] as $kept
  | [$all[$at:][] | select(.event == "load_started") | .zone] as $loaded
  | ($kept | length) > 1 and ($kept | sort) == ($resident | map(select(. != "R51")) | sort)
    and ($loaded | map(select(. as $z | $kept | index($z))) | length) == 0' live.jsonl >/dev/null ||
  fail "kept and loaded zones: $(jq -c '[.event, .zone]' live.jsonl)"
echo "an update of one zone leaves the others in memory"
