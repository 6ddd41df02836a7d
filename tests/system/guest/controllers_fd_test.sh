# SPDX-License-Identifier: Apache-2.0
# boot: controllers-fd
# Two CAN FD controllers (CTU CAN FD) with their own driver: frames arrive whole and in order.
. /payload/tests/lib.sh
for bus in can0 can1; do
  ip link set $bus type can bitrate 500000 dbitrate 2000000 fd on
  ip link set $bus txqueuelen 200 up
done
send_hundred "##1"
echo "100 FD frames with a fast data phase"
