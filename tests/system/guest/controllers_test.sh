# SPDX-License-Identifier: Apache-2.0
# boot: controllers
# Two classic controllers (SJA1000) with their own driver: frames arrive whole and in order, and a reader is told
# when its controller goes down.
. /payload/tests/lib.sh
for bus in can0 can1; do
  ip link set $bus type can bitrate 500000
  ip link set $bus txqueuelen 200 up
done
send_hundred "#"
candump can0 >reader 2>&1 &
wait_for listening can0
ip link set can0 down
told() { grep -q "Network is down" reader; }
wait_for told
echo "100 classic frames; $(tail -1 reader)"
