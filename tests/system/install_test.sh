#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: install_test.sh BUILD SOURCE DATA: installs BUILD, builds a consumer against it, runs both.
set -euo pipefail
build=$1 source=$2 data=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
"$work/prefix/bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
  --payload features --out "$work/map" >/dev/null
for components in "" packer; do
  cmake -S "$source/tests/system/consumer" -B "$work/consumer$components" -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DEXTRA_COMPONENTS="$components" >"$work/configure.log" ||
    { cat "$work/configure.log"; exit 1; }
  cmake --build "$work/consumer$components" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
  got=$("$work/consumer$components/consumer" "$work/map")
  [ "$got" = "C1 9" ] || { echo "expected 'C1 9' from the consumer, got '$got'"; exit 1; }
done
