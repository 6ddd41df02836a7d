# SPDX-License-Identifier: Apache-2.0
# What a chip that keeps its lines (PL061) is left with: after SIGTERM the safe levels; after kill -9 what it was, which
# zoned --safe-outputs mends.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
chip=$(gpiodetect | sed -n 's/.*\[\(.*pl061\)\].*/\1/p')
[ -n "$chip" ] || fail "no PL061 here: $(gpiodetect)"
mkdir -p /run/zoned
sed '/^gpio:/,$d' "$config" >robot.yaml
cat >>robot.yaml <<YAML
gpio:
  map_ready: {chip: $chip, line: 0}
  fault: {chip: $chip, line: 1}
  heartbeat: {chip: $chip, line: 2}
YAML
# Lines 0, 1, 2 by the chip's own register: asking the kernel would make them inputs.
levels() {
  data=$(busybox devmem $((0x${chip%%.*} + 0x3fc)) 8)
  echo $((data & 1))$((data >> 1 & 1))$((data >> 2 & 1))
}
mount -t debugfs none /sys/kernel/debug 2>/dev/null || true
map_is_ready() { grep -m1 '|zoned ' /sys/kernel/debug/gpio | grep -q "out hi"; }  # the chip's line 0
start_and_wait() {
  zoned run --config robot.yaml --map /payload/map --can "log:$run/can0.log" --corrections "$run/corrections.txt" \
    >zoned.log 2>&1 &
  pid=$!
  wait_for map_is_ready
}
start_and_wait
kill -TERM $pid
wait $pid || fail "status $?: $(cat zoned.log)"
[ "$(levels)" = 010 ] || fail "after SIGTERM map_ready, fault, heartbeat are $(levels), not 010"
start_and_wait
kill -KILL $pid
wait $pid || true
crashed=$(levels)
case $crashed in 10?) ;; *) fail "after kill -9 the lines are $crashed: the kernel did not leave them" ;; esac
zoned --safe-outputs --config robot.yaml || fail "--safe-outputs: status $?"
[ "$(levels)" = 010 ] || fail "after --safe-outputs the lines are $(levels), not 010"
status=0
zoned --safe-outputs 2>told || status=$?
[ $status = 2 ] || fail "without --config: status $status"
echo "after kill -9 the lines were $crashed, after --safe-outputs 010"
