#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: runtime_alone_test.sh BUILD SOURCE: where there is no packer, SQLite or OpenCV, the runtime is built by the same
# commands from the same batches of sources as in BUILD, so it is the one that is tested there; and it links none of them.
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# As BUILD is configured, whatever it is called.
sed -nE 's/^([A-Za-z0-9_.+-]+):(BOOL|STRING|PATH|FILEPATH|UNINITIALIZED)=(.*)$/set(\1 [=[\3]=] CACHE \2 "")/p' \
  "$build/CMakeCache.txt" >"$work/as_before.cmake"
cmake -S "$source" -B "$work/alone" -G Ninja -C "$work/as_before.cmake" -DZONEPACK_BUILD_PACKER=OFF -DZONEPACK_BUILD_TESTS=OFF \
  -DCMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }

commands() {  # BUILD: those that make zoned and zonectl
  ninja -C "$1" -t commands zoned zonectl | grep -v '^ninja: ' | sed "s#$1#BUILD#g" | sort
}
diff <(commands "$build") <(commands "$work/alone") || { echo "zoned or zonectl is built otherwise without the packer"; exit 1; }
count=0
while read -r batch; do
  diff <(sed "s#$build#BUILD#g" "$build/$batch") <(sed "s#$work/alone#BUILD#g" "$work/alone/$batch") ||
    { echo "$batch holds other sources without the packer"; exit 1; }
  count=$((count + 1))
done < <(commands "$build" | grep -oE 'BUILD/[^ ]*/Unity/[^ ]*\.cxx' | sed 's#^BUILD/##' | sort -u)
made=$(commands "$build" | grep -c ' -c ')
((made >= 10)) || { echo "$made sources are compiled for zoned and zonectl: expected 10 and more"; exit 1; }

for program in zoned zonectl; do
  linked=$(ldd "$build/bin/$program")
  if grep -E 'sqlite|opencv|libz\.|rsvg|cairo' <<<"$linked"; then
    echo "$program links what it does not need"
    exit 1
  fi
done
echo "$made sources, $count of them batches: the same commands without the packer"
