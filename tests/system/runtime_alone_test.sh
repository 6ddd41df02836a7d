#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: runtime_alone_test.sh SOURCE: the runtime builds without packer, SQLite and OpenCV, and zoned
# links none of them.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake -S "$1" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_UNITY_BUILD=ON -DZONEPACK_BUILD_PACKER=OFF \
  -DZONEPACK_BUILD_TESTS=OFF -DCMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/build" --target zoned zonectl >"$work/log" 2>&1 || { tail -50 "$work/log"; exit 1; }
linked=$(ldd "$work/build/bin/zoned")
if grep -E 'sqlite|opencv|libz\.|rsvg|cairo' <<<"$linked"; then
  echo "zoned links what it does not need"
  exit 1
fi
