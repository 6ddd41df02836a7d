# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# What every bus must hold, on a virtual bus of the kernel: frames, stamps through a wall clock that is set, filters,
# drops, error frames, an interface that is taken down, removed, renamed and comes back.
. /payload/tests/lib.sh
ip link add vcan0 type vcan 2>/dev/null || true
can_contract vcan0
