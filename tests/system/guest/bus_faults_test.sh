# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# The CAN interface goes down, comes up, vanishes, is made again, and its controller leaves the bus: zoned waits, says
# so, counts it, knows less and less where the robot is, and goes on by itself. Then it starts without an interface.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
start=0.88,10.98,-149
budget=$(cat /payload/budget)
send_still() {  # a robot that stands
  while :; do
    cangen can0 -g 20 -I 311 -L 8 -D 000040DB00015BCF 2>/dev/null || sleep 0.1
  done
}
sigma_um() { ask_status && value status.json sigma_m | awk '{ printf "%d", $1 * 1000000 }'; }
frames() { ask_status && value status.json can_frames; }
moving_on() { [ "$(frames)" -gt "$seen" ]; }
event() { grep -q -- "$1" events; }

vcan_up can0
zoned run --config "$config" --map /payload/map --budget "$budget" --can socketcan:can0 --start $start \
  --events events.jsonl --json result.json >zoned.log 2>&1 &
pid=$!
wait_for serving
zonectl events >events &
send_still &
sending=$!
seen=0
wait_for moving_on
status_is can_up true || fail "the bus counts as down"

ip link set can0 down
wait_for said "can0: down; no odometry until it is up again"
wait_for event odometry_stale
status_is can_up false || fail "a bus that is down counts as up"
before=$(sigma_um)
sleep 4
after=$(sigma_um)
# pose.drift_sigma_per_sqrt_s: 0.3 m after 1 s without odometry, 0.6 m after 4 s, beside what was before.
[ "$after" -ge $((before + 100000)) ] || fail "sigma grew only from $before to $after um in 4 s without odometry"
seen=$(frames)
ip link set can0 up
wait_for said "can0: up"
wait_for event odometry_resumed
wait_for moving_on

ip link del can0
wait_for said "can0: no such interface"
vcan_up can0
wait_for said "opened again"
seen=$(frames)
wait_for moving_on
status_is can_reopened 1 || fail "can_reopened: $(value status.json can_reopened)"

cansend can0 20000004#0008000000000000
wait_for said "error passive\|warns of many errors"
cansend can0 20000040#0000000000000000
wait_for said "bus-off"
wait_for event bus_off
status_is can_up false || fail "a bus-off counts as up"
cansend can0 20000100#0000000000000000
wait_for said "restarted after a bus-off"
wait_for event bus_restarted
for what in "can_up true" "can_error_frames 3" "bus_offs 1" "bus_restarts 1"; do
  # shellcheck disable=SC2086
  status_is $what || fail "not '$what' in $(cat status.json)"
done
stop_zoned
for key in budget_violations allocations minor_faults; do holds result.json $key 0; done
[ "$(grep -c '"event":"bus_off"' events.jsonl)" = 1 ] || fail "the event log tells not of one bus-off"

# An interface that is not there yet: refused, or waited for with --allow-degraded.
ip link del can0
if zoned run --config "$config" --map /payload/map --can socketcan:can0 >zoned.log 2>&1; then
  fail "ran without an interface"
fi
said "can0: no such network interface" || fail "$(cat zoned.log)"
zoned run --config "$config" --map /payload/map --can socketcan:can0 --allow-degraded --json result.json >zoned.log 2>&1 &
pid=$!
wait_for serving
vcan_up can0
seen=0
wait_for moving_on
stop_zoned
kill $sending
ip link del can0  # ends its cangen
echo "sigma $((before / 1000)) to $((after / 1000)) mm in 4 s without odometry; down, gone, bus-off: each said and left behind"
