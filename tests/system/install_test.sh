#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: install_test.sh BUILD SOURCE DATA: installs BUILD, builds all kinds of consumers against it, runs them.
set -euo pipefail
build=$1 source=$2 data=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CMAKE_EXPORT_COMPILE_COMMANDS=ON
cmake --install "$build" --prefix "$work/prefix" >"$work/install.log"
[ "$(ls "$work/prefix/include")" = zonepack ] || { echo "headers of general names are installed: $(ls "$work/prefix/include")"; exit 1; }

# What a consumer's compiler is given of this prefix is its include folder, and nothing below it.
own_include_path() {  # BUILD
  local given
  given=$(grep -oE -- "(-I|-isystem )$work/prefix[^ ]*" "$1/compile_commands.json" | sed 's/^[^/]*//' | sort -u)
  [ "$given" = "$work/prefix/include" ] || { echo "$1: on the include path: $given"; exit 1; }
}

"$work/prefix/bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
  --payload features --out "$work/map" >/dev/null
for components in "" packer; do
  cmake -S "$source/tests/system/consumer" -B "$work/consumer$components" -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DEXTRA_COMPONENTS="$components" >"$work/configure.log" ||
    { cat "$work/configure.log"; exit 1; }
  cmake --build "$work/consumer$components" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
  own_include_path "$work/consumer$components"
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
own_include_path "$work/client"
if ldd "$work/client/read_map" | grep -E 'yaml|sodium|lz4|xxhash|sqlite'; then
  echo "a client links what it does not need"
  exit 1
fi
got=$("$work/client/read_map" "$work/no.sock" L1) && { echo "expected no zoned"; exit 1; }
[ "$got" = "no zoned at $work/no.sock" ] || { echo "unexpected answer of read_map: $got"; exit 1; }

# A project of C alone, and programs built without CMake.
nobody="status 4"  # ZP_NO_SERVER
cmake -S "$source/tests/system/consumer/c_only" -B "$work/c_only" -DCMAKE_PREFIX_PATH="$work/prefix" \
  >"$work/configure.log" 2>&1 || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/c_only" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
own_include_path "$work/c_only"
got=$("$work/c_only/c_only" "$work/no.sock")
[ "$got" = "$nobody" ] || { echo "the program in C says: $got"; exit 1; }
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name zonepack.pc)")
export PKG_CONFIG_PATH
read -ra flags <<<"$(pkg-config --cflags --libs zonepack)"
cc "$source/tests/system/consumer/c_only/main.c" "${flags[@]}" -o "$work/by_hand"
[ "$("$work/by_hand" "$work/no.sock")" = "$nobody" ] || { echo "pkg-config: the program in C fails"; exit 1; }
c++ -std=c++20 "$source/tests/system/consumer/client/read_map.cpp" "${flags[@]}" -o "$work/read_map"
[ "$("$work/read_map" "$work/no.sock" L1 || true)" = "no zoned at $work/no.sock" ] || { echo "pkg-config: C++ fails"; exit 1; }
if echo "${flags[*]}" | grep -q 'include/zonepack'; then
  echo "platform/ and runtime/ are on the include path"
  exit 1
fi

# The unit starts the programs of this prefix.
unit=$work/prefix/lib/systemd/system/zoned.service
grep -q "^ExecStart=$work/prefix/bin/zoned run" "$unit" || { echo "the unit starts another zoned"; exit 1; }
! grep -n "/usr/" "$unit" || exit 1

# Another language: all it needs is installed.
"$work/prefix/bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
  --out "$work/whole" >/dev/null
export ZONED_SOCKET=$work/run/zoned.sock
"$work/prefix/bin/zoned" run --config "$work/prefix/share/zonepack/config/agilex.yaml" --map "$work/whole" \
  --can "log:$data/scenario1_loop/can0.log" --corrections "$data/scenario1_loop/corrections.txt" \
  --allow-degraded >"$work/zoned.log" 2>&1 &
zoned=$!
for ((i = 0; i < 100; ++i)); do
  [ -S "$ZONED_SOCKET" ] && break
  sleep 0.1
done
python3 "$source/tests/system/consumer/ask_status.py" "$work/prefix/share/zonepack/protocol.fbs" "$ZONED_SOCKET" |
  jq -e '.budget_bytes > 0' >/dev/null || { cat "$work/zoned.log"; kill $zoned; exit 1; }
kill $zoned
[ -n "$(find "$work/prefix" -name PROTOCOL.md)" ] || { echo "no PROTOCOL.md"; exit 1; }
