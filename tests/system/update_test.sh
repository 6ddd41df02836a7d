#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: update_test.sh BIN SOURCE: a map of a skeleton, updated with what was mapped later, is the map that a build of
# everything gives, pack for pack; what an update does not name stays byte for byte; wrong input changes nothing.
set -euo pipefail
bin=$1 data=$2/tests/data golden=$2/tests/golden
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "$*" >&2; exit 1; }
zp() { "$bin/zonepack" "$@" 2>err.txt >out.txt || fail "zonepack $*: $(cat err.txt)"; }
json() { zp "$@" --json json.json; jq -e "$check" json.json >/dev/null || fail "zonepack $*: not $check: $(cat json.json)"; }
refused() {  # CODE TEXT ARGUMENTS: with that message, and the map is as it was
  local code=$1 text=$2; shift 2
  before=$(cat map/* | sha256sum)
  set +e; "$bin/zonepack" "$@" >out.txt 2>err.txt; got=$?; set -e
  [[ $got == "$code" ]] && grep -qF -- "$text" err.txt || fail "zonepack $*: $got, not $code with '$text': $(cat err.txt)"
  [[ $(cat map/* | sha256sum) == "$before" ]] || fail "zonepack $* changed the map"
}

# Two sessions of the sample: signatures up to 92, and the rest as session 1. The skeleton has the first.
cp "$data/hospital-small.db" grown.db && chmod u+w grown.db
sqlite3 grown.db "update Node set map_id = 1 where id > 92"
cp grown.db skeleton.db
sqlite3 skeleton.db "delete from Link where from_id > 92 or to_id > 92; delete from Feature where node_id > 92;
  delete from Data where id > 92; delete from Node where id > 92"
zones=$data/zones.geojson
layers=(--layer skeleton=0 --layer rooms=1)
zp build --db skeleton.db --zones "$zones" --out skeleton "${layers[@]}"
zp build --db grown.db --zones "$zones" --out full "${layers[@]}"

# Everything that is new.
cp -r skeleton map
check='.zones_kept > 0 and .signatures_before == 92 and .signatures == 185 and .signatures_added == 93 and .ids_mapped == []'
json update map --db grown.db --add
zp verify map
check='.zones_added + .zones_removed + .zones_changed == [] and .fetch.pack_count == 0'
json diff full map
check='(.zones_changed | length) > 3 and .fetch.pack_count == (.zones_changed | length) and .signatures_after == 185'
json diff skeleton map
check='(.versions | length) == 2 and .versions[0].what == "add" and .versions[0].parent == .versions[1].version'
json log map
[[ $(jq -r '.versions[1].version' json.json) == $("$bin/zonepack" inspect skeleton --json - 2>/dev/null | jq -r .version) ]] ||
  fail "another parent"
check='.unchanged'
json update map --db grown.db --add

# One zone: the packs of all others stay.
rm -rf map && cp -r skeleton map
check='.zones_changed == ["C2"] and .zones_kept == 23'
json update map --db grown.db --replace C2
zp verify map
for pack in skeleton/*.zpk; do cmp "$pack" "map/$(basename "$pack")"; done
[[ $(cd map && ls C2-*.zpk | sort | comm -12 - <(cd ../full && ls C2-*.zpk)) ]] || fail "C2 is not as a build packs it"

# Without a session, and back.
rm -rf map && cp -r full map
check='.signatures == 92 and .signatures_removed == 93'
json update map --drop-session 1
zp verify map
zp build --db grown.db --zones "$zones" --out without --drop-session 1 "${layers[@]}"
check='.zones_changed == [] and .fetch.pack_count == 0'
json diff without map
zp build --db grown.db --zones "$zones" --out chosen --layers skeleton "${layers[@]}"
json diff without chosen

# A zone that the map does not have.
jq '.features |= map(select(.properties.name != "R51" and ((.properties.zones // []) | index("R51") | not)))' \
  "$zones" >fewer.geojson
rm -rf map && zp build --db grown.db --zones fewer.geojson --out map --orphans drop
cp -r map before
check='.zones_added == ["R51"] and .zones_changed == [] and .zones_kept == 23'
json update map --db grown.db --zones "$zones" --add
zp verify map
check='[.portals[] | select(.zones | index("R51"))] | length == 1'
json inspect map
for pack in before/*.zpk; do cmp "$pack" "map/$(basename "$pack")"; done
jq '(.features[] | select(.properties.name == "R52") | .geometry.coordinates[0]) |= map([.[0] + 0.05, .[1]])' \
  "$zones" >moved.geojson
refused 1 "zone 'R52' is drawn otherwise than in the map" update map --db grown.db --zones moved.geojson --add

# Another database: ids and sessions that clash get new numbers, once and for all.
cp grown.db other.db
sqlite3 other.db "update Node set stamp = stamp + 1000000"
rm -rf map && cp -r full map
check='(.ids_mapped | length) > 0 and (.ids_mapped | all(.to > 185)) and .sessions_mapped != []'
json update map --db other.db --replace C2
zp verify map
check='.unchanged'
json update map --db other.db --replace C2

# A reader of version 1.0 sees the zones of a map with layers and changes.
size=$(stat -c %s map/manifest.zpm)
dd if=map/manifest.zpm of=manifest.bin bs=64K iflag=skip_bytes,count_bytes skip=16 count=$((size - 56)) status=none
[[ $(od -An -tu2 -j10 -N2 map/manifest.zpm | tr -d ' ') == 1 ]] || fail "not of minor version 1"
cp "$golden/manifest-1.0.fbs" old.fbs
flatc --json --strict-json --raw-binary --defaults-json old.fbs -- manifest.bin
zp inspect map --json now.json
[[ $(jq -c '[.zones[] | [.name, .pack, .signatures]]' manifest.json) == \
   "$(jq -c '[.zones[] | [.name, .pack, .signatures]]' now.json)" ]] || fail "an old reader sees other zones"
jq -e 'has("layers") or has("changes") | not' manifest.json >/dev/null || fail "an old reader sees layers"
zp build --db grown.db --zones "$zones" --out plain
[[ $(od -An -tu2 -j10 -N2 plain/manifest.zpm | tr -d ' ') == 0 ]] || fail "a map without layers is not of minor version 0"

# Wrong input.
refused 1 "no zone 'C22' in this map" update map --db grown.db --replace C22
refused 1 "has no session 7" update map --drop-session 7
refused 1 "is in layer" update map --layer other=0
refused 2 "excludes" update map --db grown.db --replace C2 --add
refused 2 "--replace ZONE or --add" update map --db grown.db
refused 2 "--db" update map --add
refused 2 "where a session's number belongs" update map --layer rooms=x
refused 1 "none.db" update map --db none.db --add
refused 1 "is not a SQLite database" update map --db "$zones" --add
sqlite3 other.db "update Node set stamp = 5"
printf '1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n' >path.txt
refused 1 "path.txt: the alignment" update map --db other.db --replace C2 --align path.txt
printf 'a map\n' >path.txt
refused 1 "path.txt" update map --db other.db --replace C2 --align path.txt
cp map/manifest.zpm kept && printf x >>map/manifest.zpm
refused 1 "manifest.zpm" update map --db grown.db --add
cp kept map/manifest.zpm

# The plan knows layers too, and the robot loads those it is told to.
check='[.zones[] | select(.loaded)] | length < 24'
json plan full --layers skeleton
refused 1 "no zone of this map is of layer 'roms'" plan full --layers roms
zp report full --out full.svg
grep -q rooms full.svg || fail "the drawing has no layers"
if [ -x "$bin/zoned" ]; then
  run=$data/scenario1_loop
  cp "$2/config/agilex.yaml" robot.yaml && chmod u+w robot.yaml
  grep -q '^memory:' robot.yaml && sed -i 's/^memory:/memory:\n  layers: [skeleton]/' robot.yaml ||
    printf '\nmemory:\n  layers: [skeleton]\n' >>robot.yaml
  "$bin/zoned" replay --config robot.yaml --map full --can "$run/can0.log" --corrections "$run/corrections.txt" \
    --events events.jsonl --json replay.json >out.txt 2>&1 || fail "replay: $(cat out.txt)"
  "$bin/zonepack" inspect full --json - 2>/dev/null | jq -r '.zones[] | select(.layer == "rooms") | .name' >rooms.txt
  [ -s rooms.txt ] || fail "no rooms"
  jq -r 'select(.event == "load_started") | .zone' events.jsonl | sort -u >loaded.txt
  [ -s loaded.txt ] && ! grep -qxFf rooms.txt loaded.txt || fail "loaded: $(cat loaded.txt)"
  sed -i 's/layers: \[skeleton\]/layers: [skeletn]/' robot.yaml
  "$bin/zoned" replay --config robot.yaml --map full --can "$run/can0.log" >out.txt 2>&1 && fail "an unknown layer is taken"
  grep -q 'memory.layers: no zone of the map full is of layer skeletn; did you mean' out.txt || fail "$(cat out.txt)"
fi
echo "updates are builds of the same, and change nothing else"
