#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: suggest_zones_test.sh BIN SOURCE: from the sample database to a map without a person, the same bytes twice, and
# a word for everything that is wrong.
set -euo pipefail
bin=$1 data=$2/tests/data
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "$*" >&2; exit 1; }

refuses() {  # CODE WORDS OPTION...
  local want=$1 words=$2 got=0
  shift 2
  "$bin/zonepack" suggest-zones "$@" >out.txt 2>&1 || got=$?
  ((got == want)) || fail "suggest-zones $*: exit code $got, not $want: $(cat out.txt)"
  grep -qF -- "$words" out.txt || fail "suggest-zones $*: no word of '$words' in: $(cat out.txt)"
}

# From database to map.
"$bin/zonepack" suggest-zones --db "$data/hospital-small.db" --out a.geojson --preview a.html --json a.json >a.txt
grep -q "^a.geojson: .* zones (.* and .* portals from local grids" a.txt || fail "summary: $(cat a.txt)"
jq -e '(.zones | length) >= 20 and (.portals | length) >= (.zones | length) - 1 and .orphans == 0 and .apart == []' \
  a.json >/dev/null || fail "a.json: $(cat a.json)"
[ "$(jq -r '.zones[].name' a.json | sort | uniq -d)" = "" ] || fail "names twice"
grep -q "suggest-zones from" a.html || fail "the picture does not say who drew it"
"$bin/zonepack" check-zones a.geojson --db "$data/hospital-small.db" --json check.json >/dev/null
jq -e '.faults == [] and .portals_found == false and .signatures.orphans == []' check.json >/dev/null ||
  fail "check-zones: $(jq -c '.faults, .warnings' check.json)"
"$bin/zonepack" check-zones a.geojson --json check.json >/dev/null
jq -e '.warnings == []' check.json >/dev/null || fail "check-zones warns: $(jq -c .warnings check.json)"
"$bin/zonepack" build --db "$data/hospital-small.db" --zones a.geojson --out map --orphans error >/dev/null 2>&1
"$bin/zonepack" verify map >/dev/null

# The robot drives through them and is never without its own zone.
smallest=$("$bin/zonepack" plan map --json - 2>/dev/null | jq .smallest_budget_bytes)
run=$data/scenario1_loop
"$bin/zoned" replay --config "$2/config/agilex.yaml" --map map --can "$run/can0.log" \
  --corrections "$run/corrections.txt" --truth "$run/base_groundtruth.txt" --budget "$smallest" --json run.json >/dev/null
jq -e '.zone_absent_s == 0 and .budget_violations == 0' run.json >/dev/null || fail "replay: $(cat run.json)"

# The same bytes again, and from the grid that outline writes.
"$bin/zonepack" suggest-zones --db "$data/hospital-small.db" --out b.geojson >/dev/null
cmp a.geojson b.geojson
"$bin/zonepack" outline --db "$data/hospital-small.db" --out outline >/dev/null
"$bin/zonepack" suggest-zones --grid outline/map.yaml --out c.geojson >/dev/null
cmp a.geojson c.geojson

# A grid that is turned by a yaw: its zones hold the same ground, and both pictures show it below them.
sed 's/^origin:.*/origin: [3, -2, 0.5]/' outline/map.yaml >outline/turned.yaml
"$bin/zonepack" suggest-zones --grid outline/turned.yaml --out turned.geojson --preview turned.svg --json turned.json \
  >/dev/null
jq -e --slurpfile turned turned.json '[.zones[] | [.name, .portals]] == [$turned[0].zones[] | [.name, .portals]]' a.json \
  >/dev/null || fail "other zones of a turned grid"
"$bin/zonepack" check-zones turned.geojson --grid outline/turned.yaml --out check.svg >/dev/null
for picture in turned.svg check.svg; do grep -q "<image" "$picture" || fail "$picture: draws no grid"; done
grep -o '<image[^>]*>' turned.svg | cut -c1-300 >turned.txt
grep -o '<image[^>]*>' check.svg | cut -c1-300 | cmp turned.txt - || fail "two pictures of one grid differ"

# Shorter, smaller, and by rule.
for options in "--max-length 10" "--max-zone-bytes 300KiB" "--method grid:5m" "--method path:10m" "--method count:50"; do
  # shellcheck disable=SC2086
  "$bin/zonepack" suggest-zones --db "$data/hospital-small.db" --out d.geojson --json d.json $options >/dev/null
  "$bin/zonepack" check-zones d.geojson --json check.json >/dev/null || fail "$options: $(jq -c .faults check.json)"
  echo "$options: $(jq '.zones | length' d.json) zones"
  case $options in
    --max*) [ "$(jq '.zones | length' d.json)" -gt "$(jq '.zones | length' a.json)" ] || fail "$options cuts nothing" ;;
  esac
done
"$bin/zonepack" suggest-zones --db "$data/hospital-small.db" --out d.geojson --max-zone-bytes 300KiB >/dev/null
"$bin/zonepack" build --db "$data/hospital-small.db" --zones d.geojson --out small >/dev/null 2>&1
"$bin/zonepack" plan small --json - 2>/dev/null | jq -e '[.zones[].charged_bytes] | max <= 307200' >/dev/null ||
  fail "a zone charges over 300 KiB"

# What is wrong is named, and nothing is written.
cp a.geojson kept.geojson
got=0
"$bin/zonepack" check-zones a.geojson --grid outline/map.yaml >out.txt 2>&1 || got=$?
((got == 2)) && grep -q -- "--grid requires --out" out.txt || fail "check-zones --grid without --out: $(cat out.txt)"
refuses 2 "give --db or --grid" --out a.geojson
refuses 2 "'voronoi' is none of basins" --grid outline/map.yaml --out a.geojson --method voronoi
refuses 2 "'grid:0m' is none of" --grid outline/map.yaml --out a.geojson --method grid:0m
refuses 2 "follows the mapping robot's path: give --db" --grid outline/map.yaml --out a.geojson --method path:10m
refuses 2 "needs the signatures of a map" --grid outline/map.yaml --out a.geojson --max-zone-bytes 1MiB
refuses 2 "'nan' is no number" --grid outline/map.yaml --out a.geojson --door-ratio nan
refuses 2 "'-1' is no number" --grid outline/map.yaml --out a.geojson --min-area=-1
refuses 1 "no.yaml: cannot read the file" --grid no.yaml --out a.geojson
refuses 1 "none.db" --db none.db --out a.geojson
printf 'image: outline/map.pgm\nresolution: 0\norigin: [0, 0, 0]\n' >bad.yaml
refuses 1 "bad.yaml: key 'resolution' is 0" --grid bad.yaml --out a.geojson
printf 'image: gone.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n' >bad.yaml
refuses 1 "gone.pgm: cannot read the image" --grid bad.yaml --out a.geojson
printf 'image: big.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n' >bad.yaml
printf 'P5\n60000 60000\n255\n' >big.pgm
refuses 1 "60000 x 60000 pixels, at most" --grid bad.yaml --out a.geojson
{ printf 'P5\n100 100\n255\n'; head -c 10000 /dev/zero; } >big.pgm
refuses 1 "no room was found" --grid bad.yaml --out a.geojson
refuses 1 "no/such/zones.geojson" --grid outline/map.yaml --out no/such/zones.geojson
cmp a.geojson kept.geojson
