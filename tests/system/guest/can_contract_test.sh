# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# What every bus must hold, on a virtual bus of the kernel: frames, stamps through a wall clock that is set, filters,
# drops, error frames, an interface that is taken down, removed, renamed and comes back.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
export ZONEPACK_CAN_INTERFACES=vcan0  # made anew by the contract
hold_contract can_bus_contract
echo "$contract"
