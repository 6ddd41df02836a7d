#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: guest.sh FLAVOUR DEB...: build/robot/FLAVOUR/base.cpio.gz: a small Linux with packages of ours unpacked:
# busybox, iproute2, can-utils, gpiod's tools, the libraries that all these need, kernel modules, /init.
# A library that neither a package's Depends nor the tools bring is missing, and that is an error.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. toolchains/cross/debian.sh
flavour=$1 debs=("${@:2}")
use_arch "$(dpkg-deb -f "${debs[0]}" Architecture)"
kernel=$roots/kernel-$flavour
guest=$roots/guest-$arch
out=build/robot/$flavour
root=$out/root
modules="configfs can can-raw can-bcm can-gw vcan can-dev sja1000 kvaser_pci ctucanfd ctucanfd_pci gpio-irqsim gpio-sim
  virtio_pci virtio_blk crc32c_generic ext4 softdog vivid"
programs="bin/busybox bin/dash bin/ip bin/candump bin/cansend bin/cangen bin/canplayer bin/log2asc bin/gpiodetect
  bin/gpioinfo bin/gpioget bin/gpioset bin/gpiomon"

# 1. What runs there, from Debian: the tools, and what our packages depend on.
depends() { for deb in "${debs[@]}"; do dpkg-deb -f "$deb" Depends; echo ,; done | tr -d '\n' | tr ',' '\n' | awk 'NF { print $1 }'; }
mapfile -t packages < <(printf '%s\n' busybox-static dash iproute2 can-utils gpiod; depends | sort -u)
made_of() { printf '%s\n' "${packages[@]}"; cat toolchains/cross/debian.sh; }
if ! diff -q <(made_of) "$guest/.made_of" >/dev/null 2>&1; then
  fetched=$(fetch_closure "${packages[@]}")
  new_tree "$guest.new"
  for package in $fetched; do unpack "$package" "$guest.new"; done
  choose_alternatives "$guest.new"
  made_of >"$guest.new/.made_of"
  rm -rf "$guest"
  mv "$guest.new" "$guest"
fi

# 2. Our packages, the programs, and the libraries of both.
new_tree "$root"
mkdir -p "$root"/{dev,proc,sys,tmp,etc,run,payload,data,modules}
for deb in "${debs[@]}"; do unpack "$deb" "$root"; done
for program in $programs; do cp -L "$guest/$program" "$root/usr/bin/"; done
ln -s dash "$root/bin/sh"
missing=0
copy_libraries() {  # FILE...
  local file library
  for file in "$@"; do
    for library in $(readelf -dl "$file" 2>/dev/null | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p; s/.*program interpreter: .*\/\(ld-[^]]*\)\]/\1/p'); do
      [ ! -e "$root/lib/$library" ] || continue
      cp -L "$guest/usr/lib/$triplet/$library" "$root/lib/" 2>/dev/null ||
        { echo "$library, which ${file##*/} needs, is in no package of the guest" >&2; missing=1; continue; }
      copy_libraries "$root/lib/$library"
    done
  done
}
copy_libraries "$root"/bin/*
((missing == 0))

# 3. Kernel modules, each after those that it needs; one that is no file is built in.
declare -A seen
add_module() {  # NAME
  local name=${1//-/_} file needed
  [ -z "${seen[$name]:-}" ] || return 0
  seen[$name]=1
  file=$(find "$kernel/modules" -name "${1//[-_]/[-_]}.ko" | head -1)
  if [ -z "$file" ]; then
    grep -qE "/${1//[-_]/[-_]}\.ko" "$kernel/modules/modules.builtin" || { echo "the kernel has no module $1" >&2; return 1; }
    return 0
  fi
  needed=$(tr '\0' '\n' <"$file" | sed -n 's/^depends=//p' | tr ',' ' ')
  for needed in $needed; do add_module "$needed"; done
  cp "$file" "$root/modules/$name.ko"
  echo "$name" >>"$root/modules/order"
}
for module in $modules; do add_module "$module"; done

install -m755 toolchains/robot/init.sh "$root/init"
(cd "$root" && find . | LC_ALL=C sort | cpio -o -H newc -R 0:0 --quiet | gzip -1) >"$out/base.cpio.gz"
rm -rf "$root"
echo "guest: $(du -h "$out/base.cpio.gz" | cut -f1), kernel $(cat "$kernel/version")"
