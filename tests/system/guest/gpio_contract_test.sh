# SPDX-License-Identifier: Apache-2.0
# What every GPIO line must hold, on chips of the kernel's gpio-sim: levels, edges, stamps, debouncing, names, refusals.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
hold_contract gpio_line_contract
echo "$contract"
