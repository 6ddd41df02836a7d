# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# What `zoned run --record-can` writes of a bus is what candump writes beside it, stamps within 1 ms, and canplayer
# plays it again frame by frame.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
vcan_up vcan0
vcan_up vcan1
awk '/^\(/ { split($1, t, /[()]/); if (t[2] < 1718021610) print }' "$run/can0.log" >part
frames=$(odometers part)
zoned run --config "$config" --map /payload/map --can socketcan:vcan0 --record-can recorded.log >zoned.log 2>&1 &
pid=$!
wait_for serving
candump -L vcan0 >all &
wait_for listening vcan0
canplayer -I part vcan0=can0
wait_for status_is can_frames "$frames"
stop_zoned
[ "$(wc -l <recorded.log)" = "$frames" ] || fail "$(wc -l <recorded.log) lines of $frames frames recorded"
grep ' 311#' all >beside
cut -d' ' -f2,3 beside >expected
cut -d' ' -f2,3 recorded.log | cmp - expected || fail "other frames than candump's: $(head -3 recorded.log beside)"
awk '{ split($1, t, /[()]/) } FNR == NR { theirs[FNR] = t[2]; next }
  { apart = t[2] - theirs[FNR]; if (apart < 0) apart = -apart; if (apart > worst) worst = apart }
  END { printf "%.0f\n", worst * 1e6 }' beside recorded.log >apart_us
[ "$(cat apart_us)" -le 1000 ] || fail "stamps are $(cat apart_us) us apart: $(head -3 recorded.log beside)"
candump -L vcan1 >again &
wait_for listening vcan1
canplayer -I recorded.log vcan1=vcan0
arrived() { [ "$(wc -l <again)" = "$frames" ]; }
wait_for arrived
cut -d' ' -f3 recorded.log >played
cut -d' ' -f3 again | cmp - played || fail "canplayer played other frames"
echo "$frames frames as candump wrote them, stamps at most $(cat apart_us) us apart; canplayer played them again"
