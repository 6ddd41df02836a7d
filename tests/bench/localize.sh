#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: localize.sh BIN DATA [WORK]: the localizer's table, from zonepack and localize_queries and
# localize_lost in BIN.
#
# DATA holds hospital.db, hospital-small.db, zones.geojson, scenario1_loop and scenario2_roundtrip with their images.
# Each line: share of right fixes, wrong ones, errors (p50, p95) to the truth and in the map's frame, thread-CPU
# milliseconds. Build with optimisation: cmake --preset release. Takes about five minutes.
set -euo pipefail
bin=$(realpath "$1") data=$(realpath "$2")
config=$(dirname "$(realpath "$0")")/../../config/agilex.yaml
work=${3:-$(mktemp -d)}
mkdir -p "$work"
[ -n "${3:-}" ] || trap 'rm -rf "$work"' EXIT
queries() { "$bin/localize_queries" "$work/$1" "$data/$2" "${@:3}"; }

for map in hospital hospital-small; do
  [ -e "$work/$map/manifest.zpm" ] ||
    "$bin/zonepack" build --db "$data/$map.db" --zones "$data/zones.geojson" --out "$work/$map" --payload features >"$work/$map.log"
  for mission in scenario1_loop scenario2_roundtrip; do
    echo "== $map, known prior (0.3 m, 5 degrees), 500 false priors"
    queries "$map" "$mission" false=500
  done
done
for map in hospital hospital-small; do
  for mission in scenario1_loop scenario2_roundtrip; do
    echo "== $map, lost, every image a start; then with its place cut out of the map"
    for cut in 0 1; do
      "$bin/localize_lost" "$work/$map" "$data/$mission" "$config" "cut=$cut" "cache=$work/$map.$mission.lost"
    done
  done
done
echo "== camera tilted by a degree, hospital"
for tilt in roll=1 roll=-1 pitch=1 pitch=-1; do
  echo "$tilt"
  queries hospital scenario1_loop "$tilt"
done
echo "== changed images, hospital"
for change in gain:0.25 gain:2.5 gamma:2 blur:3 motion:9 motion:21 noise:10 cover:0.3 cover:0.6 flip fill:0 fill:255; do
  queries hospital scenario1_loop "change=$change" every=2
done
