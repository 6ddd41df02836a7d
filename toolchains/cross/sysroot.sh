#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: sysroot.sh ARCH: headers and libraries to build against, in $ZONEPACK_SYSROOTS/sysroot-ARCH
# (default build/): the -dev packages of packages.txt for that architecture. Kept while the list and what makes it of
# them are the same.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. toolchains/cross/debian.sh
use_arch "$1"

mapfile -t packages < <(printf '%s\n' libc6-dev libstdc++-12-dev linux-libc-dev; grep -e '-dev$' toolchains/packages.txt | grep -v clang)
made_of() { printf '%s\n' "${packages[@]}"; cat toolchains/cross/{debian,sysroot}.sh; }
if diff -q <(made_of) "$sysroot/.made_of" >/dev/null 2>&1; then
  echo "sysroot: $sysroot is there"
  exit 0
fi
debs=$(fetch_closure "${packages[@]}")
new=$sysroot.new
new_tree "$new"
for deb in $debs; do
  unpack "$deb" "$new"
  # What a program that links this library depends on: lines of "library version package (>= ...)".
  dpkg-deb --ctrl-tarfile "$deb" | tar -xO ./shlibs 2>/dev/null >>"$new/.shlibs" || true
  name=${deb##*/}  # and whose each library is, for the test of that
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed -n "s#.*/\(lib[^/]*\.so[^/]*\|ld-[^/]*\)\$#\1 ${name%%_*}#p" >>"$new/.owners"
done
# libz.so -> /lib/aarch64-linux-gnu/libz.so.1 would point into the host.
find "$new" -type l -lname '/*' | while read -r link; do ln -snfr "$new$(readlink "$link")" "$link"; done
choose_alternatives "$new"
made_of >"$new/.made_of"
rm -rf "$sysroot" "$apt_dir/cache/archives"
mv "$new" "$sysroot"
echo "sysroot: $(wc -w <<<"$debs") packages, $(du -sh "$sysroot" | cut -f1) in $sysroot"
