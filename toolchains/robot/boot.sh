#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: boot.sh FLAVOUR PAYLOAD OPTION...: boots the guest of guest.sh with the folder PAYLOAD as /payload, on this
# terminal, and exits with the status of PAYLOAD/start; 124 after TIMEOUT seconds (600), 125 without a status. The
# power is cut when the guest's console says POWER-CUT, and it boots again. OPTIONS:
#   virtual-time     the guest's clock counts instructions: sleeping takes no time, a slow host changes nothing
#   controllers      can0 and can1: two classic controllers (SJA1000) on one bus
#   controllers-fd   the same with CAN FD (CTU CAN FD)
#   disk             an ext4 file system of 64 MiB at /data, empty at the first boot
#   CONSOLE=FILE in the environment: the console's text goes there too
#   OUT=FOLDER in the environment: what lies in /data/out at the end goes there
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. toolchains/cross/debian.sh
flavour=$1 payload=$2
shift 2
case $flavour in
  armmp) qemu=(qemu-system-arm -M "virt,highmem=off" -cpu cortex-a15) ;;
  *) qemu=(qemu-system-aarch64 -M virt -cpu cortex-a72) ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
accelerator=(-accel "tcg,thread=multi")  # never KVM: a machine may offer it and not have it
devices=()
for option in "$@"; do
  case $option in
    virtual-time)
      accelerator=(-accel "tcg,thread=single" -icount "shift=2,sleep=off")
      devices+=(-rtc "base=2026-01-01,clock=vm") ;;
    controllers) devices+=(-object "can-bus,id=bus" -device "kvaser_pci,canbus=bus" -device "kvaser_pci,canbus=bus") ;;
    controllers-fd) devices+=(-object "can-bus,id=bus" -device "ctucan_pci,canbus0=bus,canbus1=bus") ;;
    disk)
      mke2fs -q -t ext4 "$work/disk" 64M
      # A flush that waits for the host's own disk would take seconds of virtual time; what the guest has flushed is
      # kept in the host's memory, which a power cut of the guest does not touch.
      devices+=(-drive "file=$work/disk,if=none,id=disk,format=raw,cache=unsafe" -device "virtio-blk-pci,drive=disk") ;;
    *) echo "unknown option '$option'" >&2; exit 2 ;;
  esac
done

mkdir "$work/root"
ln -s "$(realpath "$payload")" "$work/root/payload"
# The kernel unpacks archives one over the other.
cp "build/robot/$flavour/base.cpio.gz" "$work/initrd"
(cd "$work/root" && find -L payload | cpio -o -L -H newc -R 0:0 --quiet | gzip -1) >>"$work/initrd"
limit=(timeout --foreground -k 5 "${TIMEOUT:-600}")
if [ "${TIMEOUT:-}" = none ]; then limit=(); fi
power_cut() { grep -qs POWER-CUT "$work/console"; }
cut_when_told() {
  until power_cut; do sleep 0.2; done
  kill -KILL "$(cat "$work/pid")"
}

boot() {
  status=0
  : >"$work/console"
  "${limit[@]}" "${qemu[@]}" "${accelerator[@]}" -m 512 -nodefaults -no-user-config -display none -no-reboot \
    -chardev "stdio,id=console,signal=off,logfile=$work/console" -serial chardev:console -pidfile "$work/pid" \
    -kernel "$roots/kernel-$flavour/vmlinuz" -initrd "$work/initrd" \
    -append "console=ttyAMA0 panic=-1 loglevel=2 iomem=relaxed" "${devices[@]}" || status=$?
  cat "$work/console" >>"${CONSOLE:-/dev/null}"
}

rm -f "${CONSOLE:-}"
while
  cut_when_told &
  watcher=$!
  boot 2> >(grep -v "Killed" >&2)  # the shell tells of each power cut
  kill $watcher 2>/dev/null
  power_cut
do :; done
if [ -n "${OUT:-}" ] && [ -e "$work/disk" ]; then
  e2fsck -p "$work/disk" >/dev/null 2>&1 || true  # what was written last is in the journal
  debugfs -R "rdump /out $work" "$work/disk" 2>/dev/null
  if [ -d "$work/out" ]; then cp "$work"/out/* "$OUT/"; fi
fi
((status != 124)) || { echo "the guest took more than ${TIMEOUT:-600} s" >&2; exit 124; }
exit "$(tr -d '\r' <"$work/console" | sed -n 's/.*GUEST-EXIT:\([0-9]*\):.*/\1/p' | tail -1 | grep . || echo 125)"
