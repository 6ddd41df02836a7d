#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: same_zones_test.sh DATA ZONEPACK...: builds of zonepack by other compilers and for other processors suggest the
# same zones, byte by byte, for the sample's database, by every method.
set -euo pipefail
if [ $# -lt 3 ]; then
  sed -n 's/^# \(usage:.*\)/\1/p' "$0" >&2
  exit 2
fi
data=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for method in basins grid:5m path:10m count:50; do
  first=
  for zonepack in "$@"; do
    out=$work/zones.geojson
    "$zonepack" suggest-zones --db "$data/hospital-small.db" --method "$method" --out "$out" >"$work/log" 2>&1 ||
      { cat "$work/log" >&2; exit 1; }
    : "${first:=$work/$method}"
    [ -e "$first" ] || cp "$out" "$first"
    cmp "$first" "$out" || { echo "$zonepack: other zones by $method than $1" >&2; exit 1; }
  done
  echo "$method: the same $(grep -c Polygon "$first") zones from $# builds"
done
