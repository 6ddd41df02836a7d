#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: packages.sh BUILD ARCH OWNERS [robot]: BUILD/*.deb from the build there (target `installed`; `zoned`,
# `zonectl` and `zoneloc` for the robot's packages alone), and their sizes. OWNERS/.shlibs says which package owns a library, in lines of
# "library version package (>= ...)". The same bytes for the same commit (or SOURCE_DATE_EPOCH), built anywhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$1 arch=$2 owners=$3
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date -r CMakeLists.txt +%s)}
most_zoned_bytes=$((3 << 20))
maintainer="The Zonepack authors <zonepack@users.noreply.github.com>"

# The packages that own the libraries which the programs below DIR need, as "a, b (>= 1)".
depends_of() {  # DIR
  local needed library key
  needed=$(find "$1" -type f -perm -u+x -exec readelf -d {} + 2>/dev/null | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort -u)
  for library in $needed; do
    case $library in  # libz.so.1 is listed as "libz 1", libdb-5.3.so as "libdb 5.3"
      *.so.*) key="${library%%.so.*} ${library#*.so.}" ;;
      *) library=${library%.so} key="${library%-*} ${library##*-}" ;;
    esac
    sed -n "s/^${key//./\\.} //p" "$owners/.shlibs" | grep . || { echo "no known package owns $library" >&2; return 1; }
  done | sort -u | paste -sd, | sed 's/,/, /g'
}

write_changelog() {  # NAME: as Debian's tools read it
  printf 'zonepack (%s) stable; urgency=medium\n\n  * Changes: toolchains/CHANGELOG.md of the sources.\n\n -- %s  %s\n' \
    "$version" "$maintainer" "$(date -uRd "@$SOURCE_DATE_EPOCH")" | gzip -9n >"$tree/usr/share/doc/$1/changelog.gz"
}

write_copyright() {  # NAME
  cat >"$tree/usr/share/doc/$1/copyright" <<'COPYRIGHT'
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: zonepack

Files: *
Copyright: 2026 The Zonepack authors
License: Apache-2.0
 On Debian systems, the text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
COPYRIGHT
}

package() {  # COMPONENT SECTION DEPENDS SUMMARY; the description's body from standard input
  local name=zonepack-$1 section=$2 depends=$3 summary=$4
  tree=$build/packages/$name
  rm -rf "$tree" "$build/$name"_*.deb  # of an older version, too
  DESTDIR=$tree cmake --install "$build" --prefix /usr --component "$1" --strip >/dev/null
  mkdir -p "$tree/usr/share/doc/$name" "$tree/DEBIAN"
  write_changelog "$name"
  write_copyright "$name"
  if [ -d "$tree/usr/share/man" ]; then find "$tree/usr/share/man" -type f -exec gzip -9n {} +; fi
  [ -n "$depends" ] || depends=$(depends_of "$tree") && [ -n "$depends" ]
  cat >"$tree/DEBIAN/control" <<CONTROL
Package: $name
Source: zonepack
Version: $version
Architecture: $arch
Maintainer: $maintainer
Section: $section
Priority: optional
Installed-Size: $(du -sk --apparent-size "$tree/usr" | cut -f1)
Depends: $depends
Description: $summary
$(sed 's/^/ /')
CONTROL
  (cd "$tree" && find usr -type f -print0 | sort -z | xargs -0 md5sum >DEBIAN/md5sums)
  chmod -R u=rwX,go=rX "$tree"
  find "$tree" -exec touch -hd "@$SOURCE_DATE_EPOCH" {} +
  local deb=$build/${name}_${version}_$arch.deb
  dpkg-deb --root-owner-group --build "$tree" "$deb" >/dev/null
  printf '%8d KiB  %8d KiB installed  %s\n         needs %s\n' $(($(stat -c %s "$deb") / 1024)) \
    "$(sed -n 's/^Installed-Size: //p' "$tree/DEBIAN/control")" "$deb" "$depends"
}

package runtime misc "" "zone-wise 3D map memory for mobile robots: the robot's part" <<'BODY'
zoned keeps the rooms around a robot in memory, within a budget in bytes that
it never exceeds, and serves them to other programs. zonectl queries and
commands it.
BODY
bytes=$(stat -c %s "$build/packages/zonepack-runtime/usr/bin/zoned")
echo "zoned: $bytes bytes stripped, of at most $most_zoned_bytes"
((bytes <= most_zoned_bytes))
if [ -x "$build/bin/zoneloc" ]; then
  package localizer misc "" "zone-wise 3D map memory for mobile robots: camera localizer" <<'BODY'
zoneloc finds the robot's pose in the images of a camera, among the rooms that
zoned holds in memory, and gives it to zoned. It needs OpenCV; zoned and
zonectl do not.
BODY
fi
[ "${4:-}" != robot ] || exit 0

# Who builds against the library needs what it was built against, without test libraries and compilers.
headers=$(grep -e '-dev$' toolchains/packages.txt | grep -vE 'clang|gtest|gmock|benchmark' | paste -sd, | sed 's/,/, /g')
package tools misc "" "zone-wise 3D map memory for mobile robots: packing of maps" <<'BODY'
zonepack cuts a SLAM map into zones, such as rooms and corridors, and writes
one compressed pack per zone, for zoned to load on the robot.
BODY
package dev libdevel "$headers" "zone-wise 3D map memory for mobile robots: library to build against" <<'BODY'
Headers and static libraries for programs that read the map in zoned's memory,
in C++ or C, or that have zoned's parts built in.
BODY
