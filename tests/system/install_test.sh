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

# The program of runtime/README.md needs the client only, and is what that page shows.
diff <(sed -n '/^```cpp$/,/^```$/p' "$source/runtime/README.md" | grep -v '^```') \
  <(tail -n +2 "$source/tests/system/consumer/client/read_map.cpp") || { echo "runtime/README.md shows another program"; exit 1; }
cmake -S "$source/tests/system/consumer/client" -B "$work/client" -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_DISABLE_FIND_PACKAGE_yaml-cpp=ON >"$work/configure.log" 2>&1 ||
  { cat "$work/configure.log"; exit 1; }
cmake --build "$work/client" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
if ldd "$work/client/read_map" | grep -E 'yaml|sodium|lz4|xxhash|sqlite'; then
  echo "a client links what it does not need"
  exit 1
fi
got=$("$work/client/read_map" "$work/no.sock" L1) && { echo "expected no zoned"; exit 1; }
[ "$got" = "no zoned at $work/no.sock" ] || { echo "unexpected answer of read_map: $got"; exit 1; }
