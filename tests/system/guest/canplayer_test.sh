# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time
# The sample recording, played into vcan0 in its own time, is recorded by candump frame for frame.
. /payload/tests/lib.sh
vcan_up vcan0
candump -L vcan0 >recorded.log &
wait_for listening vcan0
started=$(cut -d. -f1 /proc/uptime)
canplayer -I "$run/can0.log" vcan0=can0
seconds=$(($(cut -d. -f1 /proc/uptime) - started))
frames=$(wc -l <"$run/can0.log")
recorded() { [ "$(wc -l <recorded.log)" = "$frames" ]; }
wait_for recorded
cut -d' ' -f3 "$run/can0.log" >expected
cut -d' ' -f3 recorded.log | cmp - expected || fail "the frames differ"
[ $seconds -ge 109 ] && [ $seconds -le 113 ] || fail "110 s of driving took $seconds s"
echo "$frames frames in $seconds s of the guest's time"
