# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time controllers-fd
# The same with two CAN FD controllers (CTU CAN FD): the drive comes in FD frames with a fast data phase.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
export ZONEPACK_CAN_INTERFACES=can0,can1
hold_contract can_bus_contract "error frames cannot be sent there" "it cannot be removed"
for bus in can0 can1; do
  ip link set $bus down
  ip link set $bus type can bitrate 500000 dbitrate 2000000 fd on
  ip link set $bus txqueuelen 200 up
done
send_hundred "##1"
drive_between_controllers "#1"
ip link set can0 down
wait_for said "can0: down"
stop_zoned
echo "$contract 100 frames, then $frames of a drive to zoned; $entered zones entered as on the host"
