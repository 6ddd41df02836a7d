#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The virtual robot for a person: the sample drive on vcan0, round and round, and a shell. `exit` switches it off.
. /payload/tests/lib.sh
set +eu
cd /tmp || exit
vcan_up vcan0
canplayer -l i -I "$run/can0.log" vcan0=can0 &
cat <<TEXT

A robot drives through the sample hospital: its wheels speak on vcan0, its map is in /payload/map.
  candump vcan0                                   listen to the bus
  zoned replay --help                             drive a recorded run
  zoned replay --config $config --map /payload/map --can $run/can0.log --corrections $run/corrections.txt
  exit                                            switch the robot off

TEXT
# Line editing; busybox's shell would prefer its own small ip.
echo "alias ip=/bin/ip; PS1='robot:\w# '" >/tmp/.profile
ENV=/tmp/.profile busybox sh
