#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: tune_test.sh BIN SOURCE: zones of the sample tuned to its drive: a zone file that builds into what was promised,
# the same bytes twice, a robot that is never without its zone, and a word for everything that is wrong.
set -euo pipefail
bin=$1 data=$2/tests/data
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "$*" >&2; exit 1; }

refuses() {  # CODE WORDS ARGUMENT...
  local want=$1 words=$2 got=0
  shift 2
  "$bin/zonepack" tune "$@" >out.txt 2>&1 || got=$?
  ((got == want)) || fail "tune $*: exit code $got, not $want: $(cat out.txt)"
  grep -qF -- "$words" out.txt || fail "tune $*: no word of '$words' in: $(cat out.txt)"
}

replay() {  # MAP BUDGET JSON
  "$bin/zoned" replay --config "$source/config/agilex.yaml" --map "$1" --can "$run/can0.log" \
    --corrections "$run/corrections.txt" --truth "$run/base_groundtruth.txt" --budget "$2" --json "$3" >/dev/null
}

source=$2 run=$data/scenario1_loop
cp "$data/hospital-small.db" map.db
"$bin/zonepack" build --db map.db --zones "$data/zones.geojson" --out map --payload features,scan,grid \
  --layer pass=0-9 >/dev/null 2>&1
there=$run/base_groundtruth.txt
# The same way back, as a second drive.
{ grep '^#' "$there"; grep -v '^#' "$there" | tac | awk '{ $1 = sprintf("%.1f", 1718100000 + NR / 10); print }'; } >back.txt

# Below the smallest budget of the drawn zones, 1.04 MiB: cut until it fits, and then for the drives.
"$bin/zonepack" tune map --drives "$there" back.txt --budget 900KiB --out a.geojson --json a.json --preview a.html >a.txt 2>a.err
jq -e '.after.smallest_budget_bytes <= 921600 and .before.smallest_budget_bytes > 921600 and .changes[0].for_budget
       and (.drives | length) == 2 and .drives[0].kind == "path"' a.json >/dev/null || fail "a.json: $(cat a.json)"
grep -q "^Next: pack them" a.txt || fail "no next step: $(cat a.txt)"
grep -q "zonepack tune" a.html || fail "the picture does not say who drew it"
grep -q "^round 1: cuts L1" a.err || fail "progress: $(cat a.err)"
"$bin/zonepack" check-zones a.geojson --db map.db --json check.json >/dev/null
jq -e '.faults == [] and .portals_found == false' check.json >/dev/null || fail "check-zones: $(jq -c .faults check.json)"
eval "$(jq -r .next a.json | sed "s|^zonepack|$bin/zonepack|")" >/dev/null 2>&1
"$bin/zonepack" verify map-tuned >/dev/null
promised=$(jq .after.smallest_budget_bytes a.json)
"$bin/zonepack" plan map-tuned --json - 2>/dev/null | jq -e ".smallest_budget_bytes == $promised" >/dev/null ||
  fail "promised $promised: $("$bin/zonepack" plan map-tuned | tail -3)"
replay map-tuned 900KiB run.json
jq -e '.zone_absent_s == 0 and .budget_violations == 0' run.json >/dev/null || fail "replay: $(cat run.json)"

# What no change touched stays: names, types, layers and the portals between zones that are left.
cat >kept.jq <<'Q'
([.changes[].zones[]] | unique) as $gone | $plan[0].features
| map(select(.properties.portal != true) | .properties | select(.name as $n | $gone | index($n) | not)
      | {name, zone_type, layer})
Q
jq --slurpfile plan a.geojson -f kept.jq a.json >kept.json
jq -e 'length >= 15 and all(.[]; .zone_type != "" and .layer == "pass")' kept.json >/dev/null || fail "kept: $(cat kept.json)"
jq -e '[.features[].properties | select(.portal == true) | .name] | unique | length > 28' a.geojson >/dev/null ||
  fail "portals: $(jq -c '.features[].properties' a.geojson)"

# Above it: changes help the drive, in the model and on the robot.
"$bin/zonepack" tune map --drives "$there" back.txt --budget 1100KiB --out b.geojson --json b.json >/dev/null 2>&1
jq -e '.after.bytes_loaded < .before.bytes_loaded and (.changes | length) > 0
       and (.load_bytes as $load | all(.changes[]; .held_out.drives_better >= .held_out.drives_worse
               and .held_out.bytes_saved + $load * .held_out.loads_saved > 0))' b.json >/dev/null || fail "b.json: $(cat b.json)"
"$bin/zonepack" build --db map.db --zones b.geojson --out b --payload features,scan,grid >/dev/null 2>&1
replay map 1100KiB before.json
replay b 1100KiB after.json
jq -es '.[1].bytes_loaded < .[0].bytes_loaded and .[1].zone_absent_s == 0' before.json after.json >/dev/null ||
  fail "the robot reads no less: $(jq -c .bytes_loaded before.json after.json)"

# The same bytes again; fixes do as well; a pinned zone stays.
"$bin/zonepack" tune map --drives "$there" back.txt --budget 900KiB --out c.geojson --preview c.html >/dev/null 2>&1
cmp a.geojson c.geojson
cmp a.html c.html
"$bin/zonepack" tune map --drives "$run/corrections.txt" --budget 900KiB --out d.geojson --json d.json >d.txt 2>&1
jq -e '.drives[0].kind == "fixes"' d.json >/dev/null || fail "d.json: $(cat d.json)"
grep -q "the first half chooses, the second half judges" d.txt || fail "d.txt: $(cat d.txt)"
"$bin/zonepack" tune map --drives "$there" back.txt --budget 4MiB --pin L1 --out e.geojson >/dev/null 2>&1
jq -e 'any(.features[]; .properties.name == "L1")' e.geojson >/dev/null || fail "L1 is pinned and gone"

# What is wrong is named, and nothing is written.
cp a.geojson kept.geojson
refuses 2 "--drives is required" map --budget 1MiB --out a.geojson
refuses 2 "--budget is required" map --drives "$there" --out a.geojson
refuses 2 "--max-changes" map --drives "$there" --budget 1MiB --out a.geojson --max-changes 0
refuses 1 "no.txt: no such file; expected a path" map --drives no.txt --budget 1MiB --out a.geojson
refuses 1 "is of a CAN log, which holds turns of wheels" map --drives "$run/can0.log" --budget 1MiB --out a.geojson
refuses 1 "zone.txt, line" map --drives "$run/zone.txt" --budget 1MiB --out a.geojson
refuses 1 "is the same drive as" map --drives "$there" "$there" --budget 1MiB --out a.geojson
awk '!/^#/ { $2 += 500 } { print }' "$there" >far.txt
refuses 1 "far.txt: is never in a zone of map; it begins at (500.875, 10.975)" map --drives far.txt --budget 1MiB --out a.geojson
head -5 "$there" >short.txt
refuses 1 "half enters no second zone" map --drives short.txt --budget 1MiB --out a.geojson
refuses 1 "no zones fit 102400 bytes" map --drives "$there" --budget 100KiB --out a.geojson
refuses 1 "no zone 'L9' in this map" map --drives "$there" --budget 1MiB --pin L9 --out a.geojson
refuses 1 "no zone of this map is of layer 'attic'" map --drives "$there" --budget 1MiB --layers attic --out a.geojson
refuses 1 "nowhere/manifest.zpm: not found" nowhere --drives "$there" --budget 1MiB --out a.geojson
refuses 1 "no/such/a.geojson" map --drives "$there" --budget 1MiB --out no/such/a.geojson
cmp a.geojson kept.geojson
# The budget that the refusal names does.
refuses 1 "no zones fit" map --drives "$there" --budget 100KiB --out f.geojson
grep -o -- '--budget [0-9]*' out.txt >hint.txt
# shellcheck disable=SC2046
"$bin/zonepack" tune map --drives "$there" $(cat hint.txt) --out f.geojson >/dev/null 2>&1 || fail "$(cat hint.txt) does not do"
