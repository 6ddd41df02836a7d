# SPDX-License-Identifier: Apache-2.0
# zoned ends in time and names the thread that hangs when a thread of its GPIO lines stands still in the kernel: the one
# that drives outputs, and the one that waits for edges of inputs.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
gpio_sim robot 8
mkdir -p /run/zoned
sed '/^gpio:/,$d' "$config" >robot.yaml
cat >>robot.yaml <<'YAML'
gpio:
  map_ready: {chip: robot, line: 2}
  heartbeat: {chip: robot, line: 4}
  hold: {chip: robot, line: 6}
YAML
ends_without() {  # THREAD
  zoned run --config robot.yaml --map /payload/map --can "log:$run/can0.log@1" --start 0,0,0 >zoned.log 2>&1 &
  pid=$!
  wait_for serving
  /payload/bin/hold_thread "$pid" "$1" 60 &
  holding=$!
  sleep 1
  began=$(centiseconds)
  kill -TERM "$pid"
  code=0
  wait "$pid" || code=$?
  took=$(($(centiseconds) - began))
  [ $code = 1 ] || fail "exit code $code, not 1, with $1 held: $(cat zoned.log)"
  [ $took -le 1200 ] || fail "it took $took centiseconds to end with $1 held"
  said "without waiting longer for the threads of the GPIO lines" || fail "$(cat zoned.log)"
  wait $holding || fail "hold_thread $1: status $?"
}
ends_without zoned-lines
first=$took
ends_without zoned-inputs
echo "ended $((first / 100)) and $((took / 100)) s after SIGTERM, naming the thread"
