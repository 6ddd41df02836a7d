#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: recording_test.sh BIN SOURCE: what zoned run records, replayed, gives the same events; state survives.
set -euo pipefail
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/expect.sh"
bin=$1 source=$2 data=$2/tests/data
mission=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/zoned.sock

"$source/tests/system/prove/recording_equality.sh" "$bin" "$source" 2

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
sed 's|^  folder: ""|  folder: state|' "$source/config/agilex.yaml" >robot.yaml
live() {
  "$bin/zoned" run --config robot.yaml --map map --can "log:$mission/can0.log@100000" \
    --corrections "$mission/corrections.txt" "${privilege[@]}" "$@"
}

# The flight recorder's folder is a recording too; settings and map may be gone.
exits 0 live --events first.jsonl --record first.zpr
rm -r map
exits 0 "$bin/zoned" replay --recording state/flight --events again.jsonl
says "without an end mark"
cmp first.jsonl again.jsonl || fail "the flight recorder differs from the run"

# The next run begins where that one ended, as a guess: not trusted before fixes agree.
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map \
  --payload features,scan,grid >/dev/null 2>&1
exits 0 live --events second.jsonl --record second.zpr
head -3 second.jsonl | grep -q '"event":"pose_initialised".*"x_mm"' || fail "no pose from before: $(head -3 second.jsonl)"
exits 0 "$bin/zoned" replay --recording second.zpr --events again.jsonl
cmp second.jsonl again.jsonl || fail "a run from a restored pose differs from its replay"
[ -d state/flight-previous ] || fail "the flight recorder of the run before is gone"

# Damage and wrong use.
head -c 120000 second.zpr >cut.zpr
exits 0 "$bin/zoned" replay --recording cut.zpr
says "ends after cycle"
head -c 100 second.zpr >cut.zpr
exits 1 "$bin/zoned" replay --recording cut.zpr
says "cut before its first cycle"
exits 1 "$bin/zoned" replay --recording robot.yaml
says "not a recording"
exits 1 live --record /nowhere/at/all
exits 2 "$bin/zoned" replay --recording second.zpr --can "$mission/can0.log"
exits 2 "$bin/zoned" replay --config robot.yaml
echo "recordings give back their runs"
