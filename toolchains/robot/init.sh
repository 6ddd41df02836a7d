#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The virtual robot's first process: mounts, modules, then /payload/start, whose status the host reads from the
# console. /bin/sh is dash: busybox's shell would run its own small "ip" whatever PATH says.
/bin/busybox --install -s /bin 2>/dev/null
export PATH=/bin HOME=/tmp TERM="${TERM:-vt100}"
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs dev /dev 2>/dev/null
mkdir -p /dev/pts /dev/shm /var/tmp
mount -t devpts pts /dev/pts
for place in /dev/shm /tmp /run; do mount -t tmpfs none $place; done
while read -r module; do insmod /modules/"$module".ko || echo "insmod $module failed"; done </modules/order
mount -t configfs configfs /sys/kernel/config
mount -t cgroup2 cgroup2 /sys/fs/cgroup
echo "+memory +cpu +pids" >/sys/fs/cgroup/cgroup.subtree_control
if [ -b /dev/vda ]; then mount -t ext4 /dev/vda /data || poweroff -f; fi
ip link set lo up
cd /payload || exit
setsid cttyhack ./start
status=$?
sync
echo "GUEST-EXIT:$status:"
poweroff -f
