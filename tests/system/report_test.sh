#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: report_test.sh BIN SOURCE: draws the sample map and the run of scenario 1 with the real programs.
set -euo pipefail
bin=$1 source=$2
data=$source/tests/data
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "$*"; exit 1; }
holds() { grep -qF -- "$2" "$1" || fail "$1 does not hold '$2'"; }  # FILE TEXT

"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out "$work/map" >/dev/null
draw_run() {  # FOLDER
  mkdir "$work/$1"
  (cd "$work/$1" && "$bin/zoned" replay --config "$source/config/agilex.yaml" --map ../map \
    --can "$data/scenario1_loop/can0.log" --corrections "$data/scenario1_loop/corrections.txt" \
    --truth "$data/scenario1_loop/base_groundtruth.txt" --max-signatures 100 --budget 2MiB \
    --baseline "$data/rtabmap_baseline/small_scenario1_loop_thr100_ret10_inittrue.csv" \
    --report run.html --picture run.svg >/dev/null)
}
draw_run one
draw_run two
"$bin/zonepack" report "$work/map" --out "$work/one/map.html"
"$bin/zonepack" report "$work/map" --out "$work/two/map.html"
"$bin/zonepack" report "$work/map" --out "$work/map.png"

# The same input gives the same bytes.
diff -r "$work/one" "$work/two" || fail "two reports of the same run differ"

# RTAB-Map's figures are known from its own log; ours from the visit of L1 H1 C2 H2 C3 (82 signatures).
holds "$work/one/run.html" '82 signatures loaded, 0 unloaded.'
holds "$work/one/run.html" '>981, 1071<'
holds "$work/one/run.svg" '>Zonepack loaded</text>'
holds "$work/one/map.html" 'main lobby with nurses station and waiting areas'
"$bin/zonepack" outline --db "$data/hospital-small.db" --out "$work/outline" >/dev/null
"$source/tests/system/report/grid_in_page.py" "$work/one/map.html" "$work/outline/map.pgm"
[ "$(head -c 4 "$work/map.png" | tail -c 3)" = PNG ] || fail "map.png is no PNG"

# A page stands alone, and no part of a file is left behind.
if grep -qE '<(script|img|iframe|link)[^>]* (src|href)=|url\(|@import' "$work"/one/*.html; then fail "a page refers to something outside"; fi
[ -z "$(find "$work" -name '*.part-*')" ] || fail "a part was left behind"

# Another kind of file is a mistake in the usage.
status=0
"$bin/zonepack" report "$work/map" --out "$work/map.pdf" 2>"$work/usage" || status=$?
[ "$status" = 2 ] || fail "expected exit code 2 for map.pdf, got $status"
holds "$work/usage" '.html, .svg or .png'

# README's picture is what the demo draws. After a wanted change: cp build/demo/scenario1.svg tests/data/readme/
"$source/toolchains/demo.sh" "$bin" "$work/demo" >/dev/null
cmp "$work/demo/scenario1.svg" "$source/tests/data/readme/scenario1.svg" ||
  fail "tests/data/readme/scenario1.svg differs from the demo's: toolchains/run demo, then copy build/demo/scenario1.svg"
