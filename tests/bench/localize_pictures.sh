#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: localize_pictures.sh BIN DATA OUT: the first page's pictures of the localizer, into the folder OUT.
#
# DATA holds hospital.db, hospital-small.db, zones.geojson, rtabmap_baseline and scenario1_loop with its images.
# loop.svg: the paper's loop closed by the camera, in the smallest budget, RTAB-Map's own fixes around it. why.png: an
# image that gives no pose, and why. To renew them: localize_pictures.sh build/release/bin DATA tests/data/readme
set -euo pipefail
bin=$(realpath "$1") data=$(realpath "$2") out=$(realpath "$3")
source=$(realpath "$(dirname "$0")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"  # the pictures name files as they are given
ln -s "$data"/scenario1_loop/* .
for map in hospital hospital-small; do
  "$bin/zonepack" build --db "$data/$map.db" --zones "$data/zones.geojson" --out "$map" >/dev/null 2>&1
done
"$bin/zoneloc" replay --config "$source/config/agilex.yaml" --map hospital --can can0.log --images rgb.txt \
  --calibration calibration.yaml --truth base_groundtruth.txt --start truth --picture loop.svg \
  --beside "$data/rtabmap_baseline/hospital_scenario1_loop_thr100_ret10_inittrue.csv"
rm rgb && ln -s "$source/tests/data/scenario1_loop/rgb" rgb  # the sample's, as the page's commands use them
"$bin/zoneloc" query --map hospital-small --image rgb/1718021680.000000.jpg --calibration calibration.yaml \
  --near 0.9,-9.4,-26 --draw why.svg
rsvg-convert --width 520 why.svg --output why.png
cp loop.svg why.png "$out"
