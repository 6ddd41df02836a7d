# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time controllers
# not on armmp: Debian's 32-bit kernel does not reach the I/O ports of QEMU's SJA1000 cards
# Two classic controllers (SJA1000) with their own driver: frames arrive whole and in order; a drive that one sends
# reaches zoned through the other; and it is told when its controller goes down, with a command that brings it up.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
export ZONEPACK_CAN_INTERFACES=can0,can1
hold_contract can_bus_contract "error frames cannot be sent there" "it cannot be removed"
for bus in can0 can1; do
  ip link set $bus down
  ip link set $bus type can bitrate 500000
  ip link set $bus txqueuelen 200 up
done
send_hundred "#"
drive_between_controllers ""
ip link set can0 down
wait_for said "can0: down"
stop_zoned
! zoned run --config "$config" --map /payload/map --can socketcan:can0 --check >table 2>&1 || fail "can0 is down"
hint=$(sed -n 's/.*can0: is down; bring it up: \(ip link .*\) (the bit rate.*/\1/p' table)
eval "${hint:-false}" || fail "does not work: $hint; $(cat table)"
zoned run --config "$config" --map /payload/map --can socketcan:can0 --check >table 2>&1 || fail "$(cat table)"
echo "$contract 100 frames, then $frames of a drive to zoned; $entered zones entered as on the host"
