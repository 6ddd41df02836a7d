# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# `zoned listen` on a live bus shows both wheels at the rate at which they are sent and nothing refused, sends nothing
# itself, and names an interface that is down or not there.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
vcan_up vcan0
awk '/^\(/ { split($1, t, /[()]/); if (t[2] < 1718021612) print }' "$run/can0.log" >part
candump -L vcan0 >all &
wait_for listening vcan0
canplayer -I part vcan0=can0 &
player=$!
zoned listen --config "$config" --can socketcan:vcan0 --duration 6 --json seen.json >table 2>words ||
  fail "status $?: $(cat words)"
wait $player || fail "canplayer: status $?"
for wheel in left right; do
  rate=$(sed -n "/\"key\": \"$wheel\"/s/.*\"rate_hz\": \([0-9]*\).*/\1/p" seen.json)
  [ "${rate:-0}" -ge 48 ] && [ "$rate" -le 52 ] || fail "$wheel wheel at $rate Hz, sent at 50: $(cat seen.json)"
done
grep -q "samples .*, 0 refused" table || fail "$(cat table)"
sent() { [ "$(wc -l <all)" = "$(grep -c '^(' part)" ]; }
wait_for sent
ip link set vcan0 down
zoned listen --config "$config" --can socketcan:vcan0 --duration 1 >table 2>words && fail "a bus that is down: $(cat table)"
grep -q "vcan0" words || fail "$(cat words)"
zoned listen --config "$config" --can socketcan:can7 --duration 1 >table 2>words && fail "no such bus: $(cat table)"
grep -q "can7: no such network interface" words || fail "$(cat words)"
echo "both wheels at $rate Hz; $(tail -1 words)"
