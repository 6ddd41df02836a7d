# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: Debian packages, from a cross build or for the machine that builds them.

make_packages() {  # BUILD ARCH OWNERS
  stage "packages: Debian $2"
  toolchains/deb/packages.sh "$@"
  tests/system/debs_test.sh "$1" "$3"
}

# What dpkg knows of this machine's own libraries, as a sysroot lists it.
host_owners() {  # DIR
  local list name libraries
  mkdir -p "$1"
  libraries="^(/usr)?/lib(64|/$(gcc -dumpmachine))/"
  grep -lE "$libraries" /var/lib/dpkg/info/*.list | while read -r list; do
    name=$(basename "$list" .list)
    grep -E "$libraries" "$list" | sed -n "s#.*/\(lib[^/]*\.so[^/]*\|ld-[^/]*\)\$#\1 ${name%%:*}#p" >&3
    cat "/var/lib/dpkg/info/$name.shlibs" 2>/dev/null || true
  done >"$1/.shlibs" 3>"$1/.owners"
}

do_deb() {
  local arch
  arch=$(dpkg --print-architecture)
  ready
  do_install packages-deb.txt
  build deb --target installed
  host_owners build/deb/owners
  make_packages build/deb "$arch" build/deb/owners
  stage "lintian: build/deb/*.deb"
  lintian --fail-on error,warning --info --tag-display-limit 0 build/deb/*.deb
  stage "done: apt-get install ./build/deb/zonepack-*_$arch.deb"
}
