# SPDX-License-Identifier: Apache-2.0
# Sourced by toolchains/run: cross-compiling, and running what it makes under qemu-user.
. toolchains/cross/debian.sh

cross_build() {  # ARCH [TARGET...]: install, sysroot, build; all targets by default
  use_arch "$1"
  do_install packages-cross.txt
  toolchains/cross/sysroot.sh "$arch"
  build "$arch" ${2:+--target "${@:2}"}
}

do_cross() {  # ARCH
  use_arch "$1" || exit 2
  ready
  cross_build "$arch"
  stage "tests: $arch units under qemu-user"
  ctest --preset "$arch" -j "$(nproc)"
  make_packages
}

# The part of `toolchains/run test`: the robot's programs, units that compute, one boot of the virtual robot, and
# armhf's zoned for the comparison of decisions. All packages and units are left to `cross`, all boots to `system`.
test_cross() {
  local units=(pack_format zones odometry)
  cross_build arm64 zoned zonectl "${device_programs[@]}" "${units[@]/#/test_}"
  stage "tests: arm64 units of the robot under qemu-user"
  ctest --preset arm64 -j "$(nproc)" -R "^($(IFS='|' && echo "${units[*]}"))/"
  make_packages runtime
  set_flavour arm64
  make_guest
  stage "system tests: on the virtual robot, arm64"
  local there=(drive_test bus_faults_test check_test)
  run_guest_tests "${there[@]}"
  stage "not run: $(guest_tests | grep -vxF "$(printf '%s\n' "${there[@]}")" | tr '\n' ' ')of the virtual robot, armhf and" \
    "PREEMPT_RT: toolchains/run system arm64, armhf, rt-arm64"
  cross_build armhf zoned
  set_flavour arm64
  replay_recordings arm64 armhf
}

make_packages() {  # [runtime]: of $arch, built
  stage "packages: Debian $arch"
  toolchains/cross/packages.sh "$arch" "$@"
  tests/system/debs_test.sh "build/$arch" "$sysroot" "$@"
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
