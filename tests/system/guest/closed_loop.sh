#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# usage: closed_loop.sh ZONELOC SETTINGS PAYLOAD OUT: the first half minute of the sample drive with fixes from its
# camera, in the smallest budget of the map; writes OUT/fixes.txt and OUT/loop.json. The host runs it as the robot does.
exec "$1" replay --config "$2" --map "$3/map" --can "$3/loop/can0.log" --images "$3/loop/rgb.txt" \
  --calibration "$3/loop/calibration.yaml" --truth "$3/loop/base_groundtruth.txt" --start truth \
  --budget "$(cat "$3/budget")" --fixes "$4/fixes.txt" --json "$4/loop.json"
