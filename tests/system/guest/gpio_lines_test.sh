# SPDX-License-Identifier: Apache-2.0
# Simulated lines: an output is seen from outside, an input is driven from outside.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
gpio_sim robot 8
gpioset -m signal "$chip" 2=1 &
driven() { [ "$(cat "$lines/sim_gpio2/value")" = 1 ]; }
wait_for driven
kill $!
for level in 1 0; do
  if [ $level = 1 ]; then echo pull-up; else echo pull-down; fi >"$lines/sim_gpio5/pull"
  [ "$(gpioget robot 5)" = $level ] || fail "line 5 does not read $level"
done
echo "line 2 seen high, line 5 read high and low"
