#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: runtime_alone_test.sh BUILD SOURCE: the runtime builds without packer, SQLite and OpenCV, and zoned links none of
# them. Beside BUILD and with the flags of preset `test`, so that a compiler cache has most of it.
set -euo pipefail
work=$(mktemp -d "$1.alone.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$2"
cmake --preset test -B "$work" -DZONEPACK_BUILD_PACKER=OFF -DZONEPACK_BUILD_TESTS=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work" --target zoned zonectl >"$work/log" 2>&1 || { tail -50 "$work/log"; exit 1; }
linked=$(ldd "$work/bin/zoned")
if grep -E 'sqlite|opencv|libz\.|rsvg|cairo' <<<"$linked"; then
  echo "zoned links what it does not need"
  exit 1
fi
