#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: kernel.sh FLAVOUR: $ZONEPACK_SYSROOTS/kernel-FLAVOUR/{vmlinuz,modules/,version}: Debian's kernel, unpacked,
# with modules that Debian leaves out, built from the source of the same version: GPIO lines that a test drives
# (gpio-sim) and the driver of QEMU's CAN FD controller (ctucanfd). Kept once made. FLAVOUR: arm64, rt-arm64, armmp.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. toolchains/cross/debian.sh
flavour=$1
case $flavour in armmp) use_arch armhf ;; *) use_arch arm64 ;; esac
kernel=$roots/kernel-$flavour
if [ -f "$kernel/version" ]; then
  echo "kernel: $(cat "$kernel/version") is there"
  exit 0
fi
work=$roots/kernel-$flavour.new
rm -rf "$kernel" "$work"
mkdir -p "$work/debs" "$work/source"
build_arch=$(dpkg --print-architecture)

fetch() {  # APT_ARCH PACKAGE...
  (cd "$work/debs" && foreign_apt "$1" download "${@:2}") 2>"$work/fetch.log" || { cat "$work/fetch.log" >&2; return 1; }
}
update_lists "$arch"
# linux-image-arm64 depends on the newest: linux-image-6.1.0-56-arm64
image=$(foreign_apt "$arch" -s install "linux-image-$flavour" | sed -n "s/^Inst \(linux-image-[0-9][^ ]*\) .*/\1/p")
release=${image#linux-image-}
fetch "$arch" "$image" "linux-headers-$release"
version=$(dpkg-deb -f "$work"/debs/"$image"_*.deb Version)
series=$(cut -d. -f1,2 <<<"$version")
common=linux-headers-${release%-"$flavour"}-common
case $flavour in rt-*) common+=-rt ;; esac
fetch "$arch" "$common=$version" "linux-source-$series=$version"
# The programs that build: of this machine's architecture, which Debian may have given a newer version by a day.
update_lists "$build_arch"
fetch "$build_arch" "linux-kbuild-$series"

for deb in "$work"/debs/*.deb; do
  case $deb in
    */linux-source-*) ;;
    *) dpkg-deb -x "$deb" "$work/tree" ;;
  esac
done
cp "$work/tree/boot/vmlinuz-$release" "$work/vmlinuz"
mv "$(find "$work/tree" -path "*/lib/modules/$release" -type d)" "$work/modules"

# The sources of the missing modules, made to build outside the kernel's own tree.
dpkg-deb --fsys-tarfile "$work"/debs/linux-source-*.deb | tar -xO "./usr/src/linux-source-$series.tar.xz" |
  tar -xJ -C "$work/source" --wildcards --transform 's#.*/##' '*/drivers/gpio/gpio-sim.c' '*/drivers/gpio/gpiolib.h' \
    '*/kernel/irq/irq_sim.c' '*/drivers/net/can/ctucanfd/*.[ch]'
sed -i 's/handle_simple_irq(irq_to_desc(irqnum))/generic_handle_irq(irqnum)/' "$work/source/irq_sim.c"  # exported one
printf '#include <linux/module.h>\nMODULE_LICENSE("GPL");\n' >>"$work/source/irq_sim.c"
sed -i '/^MODULE_DEVICE_TABLE/d' "$work"/source/*.c  # for loading by itself; a 64-bit modpost misreads 32-bit ones
cat >"$work/source/Makefile" <<'MAKEFILE'
obj-m := gpio-irqsim.o gpio-sim.o ctucanfd.o ctucanfd_pci.o
gpio-irqsim-y := irq_sim.o
ctucanfd-y := ctucanfd_base.o
MAKEFILE
headers=$work/tree/usr/src/linux-headers-$release
sed -i "s#^include .*/\(linux-headers-[^/]*\)/Makefile#include $work/tree/usr/src/\1/Makefile#" "$headers/Makefile"
make -s -C "$headers" ARCH="$kernel_arch" CROSS_COMPILE="$triplet-" M="$work/source" modules >"$work/make.log" 2>&1 ||
  { tail -20 "$work/make.log"; exit 1; }
"$triplet-strip" --strip-debug "$work"/source/*.ko
mkdir "$work/modules/extra"
cp "$work"/source/*.ko "$work/modules/extra/"
rm -rf "$work"/{debs,tree,source}
echo "$release $version" >"$work/version"
mv "$work" "$kernel"
echo "kernel: $(cat "$kernel/version"), with $(cd "$kernel/modules/extra" && echo *.ko)"
