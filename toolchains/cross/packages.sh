#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: packages.sh ARCH [runtime]: build/ARCH/*.deb from the build there (target `installed`; `zoned` for the
# runtime alone), and their sizes. The same bytes for the same commit (or SOURCE_DATE_EPOCH), built anywhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. toolchains/cross/debian.sh
use_arch "$1"
build=build/$arch
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date -r CMakeLists.txt +%s)}
most_zoned_bytes=$((3 << 20))

# The packages that own the libraries which the programs below DIR need, as "a, b (>= 1)".
depends_of() {  # DIR
  local needed library key
  needed=$(find "$1" -type f -perm -u+x -exec readelf -d {} + 2>/dev/null | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort -u)
  for library in $needed; do
    case $library in  # libz.so.1 is listed as "libz 1", libdb-5.3.so as "libdb 5.3"
      *.so.*) key="${library%%.so.*} ${library#*.so.}" ;;
      *) library=${library%.so} key="${library%-*} ${library##*-}" ;;
    esac
    sed -n "s/^${key//./\\.} //p" "$sysroot/.shlibs" | grep . || { echo "no package of the sysroot owns $library" >&2; return 1; }
  done | sort -u | paste -sd, | sed 's/,/, /g'
}

package() {  # COMPONENT DEPENDS DESCRIPTION
  local name=zonepack-$1 tree=$build/packages/zonepack-$1 depends=$2
  rm -rf "$tree"
  DESTDIR=$tree cmake --install "$build" --prefix /usr --component "$1" --strip >/dev/null
  install -Dm644 LICENSE "$tree/usr/share/doc/$name/copyright"
  [ -n "$depends" ] || depends=$(depends_of "$tree") && [ -n "$depends" ]
  mkdir "$tree/DEBIAN"
  cat >"$tree/DEBIAN/control" <<CONTROL
Package: $name
Version: $version
Architecture: $arch
Maintainer: The Zonepack authors
Section: misc
Priority: optional
Installed-Size: $(du -sk --apparent-size "$tree/usr" | cut -f1)
Depends: $depends
Description: $3
CONTROL
  chmod -R u=rwX,go=rX "$tree"
  find "$tree" -exec touch -hd "@$SOURCE_DATE_EPOCH" {} +
  local deb=$build/${name}_${version}_$arch.deb
  dpkg-deb --root-owner-group --build "$tree" "$deb" >/dev/null
  printf '%8d KiB  %8d KiB installed  %s\n         needs %s\n' $(($(stat -c %s "$deb") / 1024)) \
    "$(sed -n 's/^Installed-Size: //p' "$tree/DEBIAN/control")" "$deb" "$depends"
}

package runtime "" "zone-wise 3D map memory for mobile robots: the robot's part"
bytes=$(stat -c %s "$build/packages/zonepack-runtime/usr/bin/zoned")
echo "zoned: $bytes bytes stripped, of at most $most_zoned_bytes"
((bytes <= most_zoned_bytes))
[ "${2:-}" != runtime ] || exit 0

# Who builds against the library needs what it was built against, without test libraries and compilers.
headers=$(grep -e '-dev$' toolchains/packages.txt | grep -vE 'gtest|gmock|benchmark' | paste -sd, | sed 's/,/, /g')
package tools "" "zone-wise 3D map memory for mobile robots: packing of maps"
package dev "$headers" "zone-wise 3D map memory for mobile robots: library to build against"
