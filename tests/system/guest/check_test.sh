# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# zoned run --check tells what this kernel is, above all whether it is a PREEMPT_RT one, and refuses nothing here.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
vcan_up vcan0
zoned run --config "$config" --map /payload/map --can socketcan:vcan0 --check >table || fail "$(cat table)"
case $(uname -v) in
  *PREEMPT_RT*) row="ok  *PREEMPT_RT  *yes" ;;
  *) row="weak  *PREEMPT_RT  *no" ;;
esac
grep -q "$row" table || fail "no row like '$row' in: $(cat table)"
grep -q "$(uname -r)" table || fail "the kernel $(uname -r) is not in: $(cat table)"
echo "$(grep PREEMPT_RT table); $(tail -1 table)"
