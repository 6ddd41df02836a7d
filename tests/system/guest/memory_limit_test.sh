# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# A control group's memory.max holds: 20 MiB fit under 32 MiB, 64 MiB are killed, and both are counted.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
group=/sys/fs/cgroup/limit
mkdir $group
echo 32M >$group/memory.max
in_cgroup limit dd if=/dev/zero of=/dev/null bs=20M count=1 2>/dev/null || fail "20 MiB did not fit under 32 MiB"
status=0
in_cgroup limit dd if=/dev/zero of=/dev/null bs=64M count=1 2>/dev/null || status=$?
[ $status = 137 ] || fail "64 MiB under a limit of 32 MiB: status $status, expected to be killed (137)"
grep -q '^oom_kill 1$' $group/memory.events || fail "memory.events does not tell of one kill"
[ "$(cat $group/memory.peak)" = 33554432 ] || fail "memory.peak is $(cat $group/memory.peak), not the limit"
echo "20 MiB fit, 64 MiB killed, peak $(cat $group/memory.peak)"
