#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: learn_test.sh BIN SOURCE: zoned learn counts drives; runs load by it, learn on, and are replayed the same.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/expect.sh"
bin=$1 source=$2 data=$2/tests/data
mission=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/zoned.sock

key() { python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$1" "$2"; }

"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
cp "$source/config/agilex.yaml" plain.yaml
settings() {  # FILE TRANSITIONS LEARN: the plain settings with these
  sed "s|^  transitions: \"\"|  transitions: $2|; s|^  learn: false|  learn: $3|; s|^  folder: \"\"|  folder: state|" \
    plain.yaml >"$1"
}
replay() {  # CONFIG JSON [OPTION...]
  exits 0 "$bin/zoned" replay --config "$1" --map map --can "$mission/can0.log" --corrections "$mission/corrections.txt" \
    --storage-rate 60000 --json "$2" "${@:3}"
}

# A text file of zones and a CAN log with its fixes say nearly the same.
exits 0 "$bin/zoned" learn "$mission/zone.txt" "$mission/zone.txt" --map map --out habits.zpt --json learn.json
[ "$(key learn.json method)" = leave-one-out ] || fail "not leave-one-out: $(cat learn.json)"
# The second drive is the first again: whatever order 2 tells apart is foreseen.
python3 -c 'import json; d = json.load(open("learn.json")); assert d["first"] >= 0.8 > d["first_untrained"], d'
exits 0 "$bin/zoned" learn --map map --out logged.zpt --json logged.json --config plain.yaml --can "$mission/can0.log" \
  --corrections "$mission/corrections.txt"
[ "$(key logged.json method)" = steps-so-far ] || fail "of one drive: $(cat logged.json)"
exits 0 "$bin/zoned" learn "$mission/zone.txt" --from habits.zpt --map map --out more.zpt
says "context"

# It is read, makes the robot wait less or as long, and without it nothing changes.
settings habits.yaml habits.zpt false
replay plain.yaml plain.json
replay habits.yaml habits.json --events first.jsonl
python3 - <<'END'
import json
plain, habits = json.load(open("plain.json")), json.load(open("habits.json"))
assert plain["zone_absent_s"] > 0 and habits["zone_absent_s"] < plain["zone_absent_s"] / 2, (plain, habits)
END
replay habits.yaml again.json --events again.jsonl
cmp first.jsonl again.jsonl || fail "a replay is not repeatable"

# The whole route is loaded ahead: nothing is waited for.
route=$(awk '$1 != "#" && $2 != z { z = $2; r = r (r ? "/" : "") z } END { print r }' "$mission/zone.txt")
first=$(awk '$1 != "#" { print $1; exit }' "$mission/zone.txt")
{ cat "$mission/corrections.txt"; echo "# command $first route_hint $route"; } >hinted.txt
exits 0 "$bin/zoned" replay --config plain.yaml --map map --can "$mission/can0.log" --corrections hinted.txt \
  --storage-rate 60000 --json hinted.json
python3 -c 'import json; a, b = (json.load(open(n + ".json"))["zone_absent_s"] for n in ("hinted", "plain")); assert a < b / 2, (a, b)'

# A live run learns on, and its recording needs no file; the next run goes on from there.
privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
settings live.yaml habits.zpt true
live() {
  "$bin/zoned" run --config live.yaml --map map --can "log:$mission/can0.log@100000" \
    --corrections "$mission/corrections.txt" --storage-rate 60000 "${privilege[@]}" "$@"
}
exits 0 live --events run.jsonl --record run.zpr
[ -s state/transitions.zpt ] || fail "nothing learned was kept"
cp state/transitions.zpt once.zpt
exits 0 live --events second.jsonl --record second.zpr
cmp -s once.zpt state/transitions.zpt && fail "the second run learned nothing"
mv habits.zpt away.zpt
exits 0 "$bin/zoned" replay --recording run.zpr --events again.jsonl
cmp run.jsonl again.jsonl || fail "a run with habits differs from its replay"
exits 0 "$bin/zoned" replay --recording second.zpr --events again.jsonl
cmp second.jsonl again.jsonl || fail "a run that went on learning differs from its replay"
exits 0 "$bin/zoned" learn run.zpr --map map --out recorded.zpt
exits 1 live
says "preload.transitions: .*habits.zpt: "
mv away.zpt habits.zpt
exits 0 "$bin/zoned" run --config live.yaml --map map --can "log:$mission/can0.log" --check "${privilege[@]}"
says "transitions .* of the budget"

# What is damaged, foreign or wrong is named.
head -c 50 habits.zpt >cut.zpt
settings cut.yaml cut.zpt false
exits 1 "$bin/zoned" replay --config cut.yaml --map map --can "$mission/can0.log"
says "preload.transitions: .*cut.zpt: holds 26 of"
exits 1 "$bin/zoned" learn "$mission/can0.log" --map map --out x.zpt
says "can0.log:1: "
exits 1 "$bin/zoned" learn /nowhere --map map --out x.zpt
exits 1 "$bin/zoned" learn plain.yaml --map map --out x.zpt
says "plain.yaml:"
echo "1 Attic" >attic.txt
exits 1 "$bin/zoned" learn attic.txt --map map --out x.zpt
says "attic.txt: holds no step"
[ ! -e x.zpt ] || fail "a file was written all the same"
exits 2 "$bin/zoned" learn --map map --out x.zpt
exits 2 "$bin/zoned" learn --map map --out x.zpt --can "$mission/can0.log"
