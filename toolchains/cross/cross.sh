# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: cross-compiling, and running what it makes under qemu-user.
. toolchains/cross/debian.sh

cross_build() {  # ARCH [TARGET...]: install, sysroot, build; all targets by default
  use_arch "$1"
  do_install packages-cross.txt
  toolchains/cross/sysroot.sh "$arch"
  build "$arch" ${2:+--target "${@:2}"}
}

do_cross() {  # ARCH [UNIT...]: the unit tests of all folders by default
  local units=("${@:2}")
  use_arch "$1" || exit 2
  ready
  if ((${#units[@]})); then
    cross_build "$arch" installed "${units[@]/#/test_}"
    ctest_of "$arch" "$arch units under qemu-user: ${units[*]}" -R "^($(IFS='|' && echo "${units[*]}"))\$"
  else
    cross_build "$arch"
    ctest_of "$arch" "$arch units under qemu-user"
  fi
  make_packages "build/$arch" "$arch" "$sysroot"
}

# A program that runs build/ARCH/bin/PROGRAM under qemu-user.
emulated() {  # ARCH PROGRAM
  use_arch "$1"
  local program=build/$arch/emulated/$2
  mkdir -p "${program%/*}"
  printf '#!/bin/sh\nexec %s -L %s %s "$@"\n' "$emulator" "$sysroot" "$PWD/build/$arch/bin/$2" >"$program"
  chmod +x "$program"
  echo "$program"
}
