# SPDX-License-Identifier: Apache-2.0
# The robot's lines during a drive, seen and driven from outside: map_ready follows loads, the heartbeat beats, dock,
# hold and a marker reach the control thread and are recorded; a busy or missing line is refused by name.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
gpio_sim robot 8
mkdir -p /run/zoned
sed '/^gpio:/,$d; s/rate_limit: 0/rate_limit: 30000/' "$config" >robot.yaml
cat >>robot.yaml <<'YAML'
gpio:
  map_ready: {chip: robot, line: 2}
  fault: {chip: robot, line: 3, active_low: true}
  heartbeat: {chip: robot, line: 4}
  dock: {chip: robot, line: 5, active_low: true, bias: pull-up, x: 1.5, y: 5, yaw: 0}
  hold: {chip: robot, line: 6}
  zone_markers:
    door: {chip: robot, line: 7, zones: [L1, H1], reach: 3}
YAML
awk '/^\(/ { split($1, t, /[()]/); if (t[2] < 1718021630) print }' "$run/can0.log" >half.log
zoned_run() { zoned run --config robot.yaml --map /payload/map --can log:half.log --corrections "$run/corrections.txt" "$@"; }
drive_from_outside() { echo "pull-$2" >"$lines/sim_gpio$1/pull"; }

gpioset -m signal "$chip" 2=0 &
other=$!
held() { gpioinfo "$chip" | grep -q gpioset; }
wait_for held
zoned_run >refused 2>&1 && fail "a busy line was not refused"
grep -q "gpio.map_ready: line 2 of chip robot: held by gpioset" refused || fail "$(cat refused)"
zoned_run --check >checked && fail "--check lets a busy line pass"
grep -q "REFUSED  line map_ready .*held by gpioset" checked || fail "$(cat checked)"
grep -q "ok       line hold .*line 6, free for input" checked || fail "$(cat checked)"
kill $other
free() { ! held; }
wait_for free

watch_line() {  # LINE: its values, a line for each change
  last=
  while [ -e going ]; do
    read -r now <"$lines/sim_gpio$1/value"
    [ "$now" = "$last" ] || echo "$now"
    last=$now
    sleep 0.01
  done >"seen_$1"
}
drive_from_outside 5 up
: >going
for line in 2 3 4; do watch_line $line & done
zoned_run --events events.jsonl --json result.json --record run.zpr >zoned.log 2>&1 &
pid=$!
ready() { [ "$(cat "$lines/sim_gpio2/value")" = 1 ]; }
wait_for ready
[ "$(cat "$lines/sim_gpio3/value")" = 1 ] || fail "map_ready beside fault (active low)"
drive_from_outside 6 up
sleep 1
drive_from_outside 6 down
drive_from_outside 7 up
sleep 6
drive_from_outside 5 down
sleep 1
drive_from_outside 5 up
wait $pid || fail "status $?: $(cat zoned.log)"
rm going
for word in hold_begun hold_ended undocked; do
  grep -q "\"event\":\"$word\"" events.jsonl || fail "no event $word: $(grep -v zone_ events.jsonl)"
done
grep -q '"event":"docked".*"x_mm":15[0-9][0-9],"y_mm":50[0-9][0-9],' events.jsonl || fail "$(grep docked events.jsonl)"
grep -Eq '"event":"(zone_confirmed|marker_ignored)"' events.jsonl || fail "the marker was lost"
zoned replay --recording run.zpr --events again.jsonl >/dev/null || fail "the recording cannot be replayed"
cmp again.jsonl events.jsonl || fail "the recording gives other events"
beats=$(wc -l <seen_4)
[ "$beats" -ge 100 ] || fail "the heartbeat changed $beats times in half a minute"
grep -q 1 seen_2 || fail "map_ready was never seen: $(cat seen_2)"
count=$(sed -n 's/.*"map_ready_latency_count": \([0-9]*\).*/\1/p' result.json)
[ "$count" -ge 1 ] || fail "no load was waited for: $(cat result.json)"
sed -i 's/line: 2}/line: 9}/' robot.yaml
zoned_run --allow-degraded --json degraded.json >zoned.log 2>&1 || fail "refused: $(cat zoned.log)"
grep -q "gpio.map_ready: line 9 of chip robot: the chip has no such line" zoned.log || fail "$(cat zoned.log)"
grep -q '"lines_not_working": 1' degraded.json || fail "$(cat degraded.json)"
echo "map_ready changed $(($(wc -l <seen_2) - 1)) times, heartbeat $beats; load to map_ready, us:" \
  "$(sed -n 's/.*"map_ready_latency_us": {\([^}]*\)}.*/\1/p' result.json), $count loads"
