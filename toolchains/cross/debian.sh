# SPDX-License-Identifier: Apache-2.0
# Sourced: names of one Debian architecture, and packages of it fetched and unpacked without installing them.
#
# A foreign architecture in the host's dpkg (multiarch) would remove installed packages: many -dev packages
# exist once per machine. So apt runs on folders of its own, with an empty list of installed packages and the
# machine's own sources and keys; nothing on the host changes, and no root is needed.

roots=$(realpath -m "${ZONEPACK_SYSROOTS:-build}")

# shellcheck disable=SC2034  # for those who source this
use_arch() {  # ARCH: sets arch, triplet, kernel_arch, sysroot, emulator, apt_dir
  arch=$1
  case $arch in
    arm64) triplet=aarch64-linux-gnu kernel_arch=arm64 emulator=qemu-aarch64-static ;;
    armhf) triplet=arm-linux-gnueabihf kernel_arch=arm emulator=qemu-arm-static ;;
    *) echo "unknown architecture '$arch': expected arm64 or armhf" >&2; return 2 ;;
  esac
  sysroot=$roots/sysroot-$arch
  apt_dir=$roots/apt-$arch
}

# For ARCH or the host's own architecture; arguments are apt-get's.
foreign_apt() {  # APT_ARCH ARGUMENT...
  local apt_arch=$1 dir=$roots/apt-$1
  shift
  mkdir -p "$dir/state/lists/partial" "$dir/cache/archives/partial"
  : >>"$dir/status"
  apt-get -qq -y -o APT::Architecture="$apt_arch" -o APT::Architectures::="$apt_arch" \
    -o Dir::State="$dir/state" -o Dir::State::status="$dir/status" -o Dir::Cache="$dir/cache" \
    -o APT::Sandbox::User="$(id -un)" -o APT::Install-Recommends=0 -o Acquire::Languages=none "$@"
}

# Index lists are good for a day. apt leaves out a list that a mirror is just replacing: said, not fatal.
update_lists() {  # APT_ARCH
  local stamp=$roots/apt-$1/updated
  mkdir -p "$roots/apt-$1"
  [ -z "$(find "$stamp" -mmin -1440 2>/dev/null)" ] || return 0
  if foreign_apt "$1" update 2>"$roots/apt-$1/update.log"; then
    touch "$stamp"
  else
    echo "warning: the package lists of $1 are incomplete, see $roots/apt-$1/update.log" >&2
  fi
}

# Downloads packages of $arch with all that they depend on, and prints the .deb files.
fetch_closure() {  # PACKAGE...
  update_lists "$arch"
  foreign_apt "$arch" --download-only install "$@" >&2
  foreign_apt "$arch" -s install "$@" | sed -n 's/^Inst \([^ ]*\) (\([^ ]*\) .*/\1 \2/p' |
    while read -r name version; do ls "$apt_dir/cache/archives/${name%%:*}_${version//:/%3a}"_*.deb; done
}

# A folder as Debian lays it out, with lib -> usr/lib; "dpkg-deb -x" would replace such links by folders.
new_tree() {  # DIR
  rm -rf "$1"
  mkdir -p "$1"/usr/{lib,bin,sbin}
  local dir
  for dir in lib bin sbin; do ln -s "usr/$dir" "$1/$dir"; done
}

unpack() {  # DEB DIR
  dpkg-deb --fsys-tarfile "$1" | tar -x --keep-directory-symlink --no-same-owner -C "$2" \
    --exclude='./usr/share/doc/*' --exclude='./usr/share/man/*' --exclude='./usr/share/locale/*'
}

# Links that a package's installation would make by update-alternatives: OpenCV asks for libblas.so.3, which lies in
# blas/, where it can stand next to other implementations.
choose_alternatives() {  # DIR
  local library
  for library in "$1"/usr/lib/"$triplet"/{blas,lapack}/lib*.so.3; do
    [ ! -e "$library" ] || ln -snfr "$library" "$1/usr/lib/$triplet/${library##*/}"
  done
}
