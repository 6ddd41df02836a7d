# SPDX-License-Identifier: Apache-2.0
# What every GPIO line must hold, on chips of the kernel's gpio-sim: levels, edges, stamps, debouncing, names, refusals.
. /payload/tests/lib.sh
/payload/bin/gpio_line_contract || fail "the contract is broken"
/payload/bin/gpio_line_contract --gtest_brief=1 >told
grep -q SKIPPED told && fail "not tested: $(cat told)"
grep PASSED told
