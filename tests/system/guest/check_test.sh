# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# zoned run --check tells what this kernel is, above all whether it is a PREEMPT_RT one, and refuses nothing here. What
# it says of a bus that is missing or down and of the kernel's settings works when typed.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
check() { zoned run --config "$config" --map /payload/map --can socketcan:"$1" --check >table 2>&1; }

# A virtual bus: made, then brought up, by what the messages say.
ip link del vcan5 2>/dev/null || true
for lacks in "vcan5: no such network interface" "vcan5: is down"; do
  ! check vcan5 || fail "a bus that is not up is taken: $(cat table)"
  hint=$(sed -n "s/.*$lacks; [a-z ]*: \(ip link [^;]*\).*/\1/p" table)
  [ -n "$hint" ] || fail "no command after '$lacks' in: $(cat table)"
  eval "$hint" || fail "does not work: $hint"
  ip link set vcan5 down
done
ip link set vcan5 up
check vcan5 || fail "$(cat table)"
ip link del vcan5

vcan_up vcan0
check vcan0 || fail "$(cat table)"
case $(uname -v) in
  *PREEMPT_RT*) row="ok  *PREEMPT_RT  *yes" ;;
  *) row="weak  *PREEMPT_RT  *no" ;;
esac
grep -q "$row" table || fail "no row like '$row' in: $(cat table)"
grep -q "$(uname -r)" table || fail "the kernel $(uname -r) is not in: $(cat table)"
echo "$(grep PREEMPT_RT table); $(tail -1 table)" >result

# As a kernel begins; another test in this boot may have set them as the package does.
sysctl -q -w kernel.sched_rt_runtime_us=950000 vm.compact_unevictable_allowed=1
check vcan0 || fail "$(cat table)"
grep -o 'mend: sysctl .*' table | sed 's/mend: //' >mends
[ -s mends ] || fail "no sysctl in: $(cat table)"
while read -r mend; do
  eval "$mend" >/dev/null || fail "does not work: $mend"
done <mends
check vcan0 || fail "$(cat table)"
! grep 'mend: sysctl' table || fail "not mended by: $(cat mends)"
echo "$(cat result); $(wc -l <mends) of its commands typed"
