#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: debs_test.sh BUILD OWNERS: the .deb packages in BUILD hold what they are named after, and the programs in them
# need exactly the packages that own their libraries, as the list OWNERS/.owners says, in lines of "library package".
set -euo pipefail
build=$1 owners=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

check() {  # PACKAGE FILE...: has these files, and depends on the owners of what its programs need
  local deb=("$build/$1"_*.deb) file library
  [ "${#deb[@]}" = 1 ] || { echo "expected one $1 in $build, found ${deb[*]}"; exit 1; }
  dpkg-deb -c "${deb[0]}" >"$work/files"
  for file in "${@:2}"; do
    grep -qE " \./$file$" "$work/files" || { echo "${deb[0]}: no $file"; exit 1; }
  done
  dpkg-deb -x "${deb[0]}" "$work/$1"
  [ -d "$work/$1/usr/bin" ] || return 0
  for library in $(readelf -d "$work/$1"/usr/bin/* | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | sort -u); do
    awk -v library="$library" '$1 == library { print $2; found = 1 } END { if (!found) print "nobody:" library }' \
      "$owners/.owners"
  done | sort -u >"$work/owners"
  dpkg-deb -f "${deb[0]}" Depends | tr ',' '\n' | awk '{ print $1 }' | sort -u >"$work/depends"
  diff "$work/owners" "$work/depends" ||
    { echo "${deb[0]}: '<' owns a library that is needed, '>' is in Depends"; exit 1; }
}

check zonepack-runtime usr/bin/zoned usr/share/man/man1/zonectl.1.gz usr/share/bash-completion/completions/zoned \
  usr/lib/systemd/system/zoned.service usr/share/zonepack/config/agilex.yaml
if compgen -G "$build/zonepack-localizer_*.deb" >/dev/null; then
  check zonepack-localizer usr/bin/zoneloc usr/share/man/man1/zoneloc.1.gz \
    usr/share/bash-completion/completions/zoneloc usr/lib/systemd/system/zoneloc.service
fi
for program in zoned zonectl; do
  if readelf -d "$work/zonepack-runtime/usr/bin/$program" | grep -E 'opencv|jpeg|png'; then
    echo "$program is linked to the libraries of zoneloc"
    exit 1
  fi
done
check zonepack-tools usr/bin/zonepack usr/share/man/man1/zonepack.1.gz
check zonepack-dev 'usr/lib/[a-z0-9_-]+/libzonepack_runtime.a' 'usr/lib/[a-z0-9_-]+/cmake/zonepack/zonepackConfig.cmake' \
  usr/include/zonepack/platform/base/result.hpp
echo "packages: their files are there, and Depends names the owners of all libraries they need"
