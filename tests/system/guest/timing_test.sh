# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# The worst wake-up and the worst cycle of the control thread over several runs, on a processor that takes
# 4 ns for an instruction whatever the host does: none over 200 us, which is 50 us where an instruction takes 1 ns.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
runs=$(cat /payload/runs)
vcan_up vcan0
awk '/^\(/ { split($1, t, /[()]/); if (t[2] >= 1718021610 && t[2] < 1718021620) print }' "$run/can0.log" >part
sum_up() { sort -n "$1" | awk '{ a[NR] = $1 } END { printf "%g to %g", a[1], a[NR] }'; }
for i in $(seq "$runs"); do
  zoned run --config "$config" --map /payload/map --can socketcan:vcan0 --start 0.88,10.98,-149 --json result.json \
    >zoned.log 2>&1 &
  pid=$!
  wait_for serving
  canplayer -I part vcan0=can0
  stop_zoned
  for key in missed_deadlines allocations minor_faults major_faults; do holds result.json $key 0; done
  for what in wakeup_us cycle_us; do took result.json $what max >>$what; done
  holds result.json can_frames "$(odometers part)"
done
awk '$1 > 200 { exit 1 }' cycle_us || fail "a cycle took over 200 us: $(sum_up cycle_us) us"
awk '$1 > 200 { exit 1 }' wakeup_us || fail "a wake-up came over 200 us late: $(sum_up wakeup_us) us"
echo "$runs runs of $(value result.json cycles) cycles: worst wake-up $(sum_up wakeup_us) us late, worst cycle $(sum_up cycle_us) us"
