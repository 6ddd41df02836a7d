#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The virtual robot for a person: the sample drive on vcan0 and through zoned, again and again, and a shell.
# `exit` switches it off.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
set +eu
cd /tmp || exit
vcan_up vcan0
mkdir -p /run/zoned
while :; do
  canplayer -I "$run/can0.log" vcan0=can0 &
  zoned run --config "$config" --map /payload/map --can "log:$run/can0.log" --corrections "$run/corrections.txt" \
    --max-signatures 100 --allow-degraded >>zoned.log 2>&1 || sleep 5
  wait $!
done &
cat <<TEXT

A robot drives through the sample hospital, two minutes, again and again.
  zonectl watch        what is in memory while it drives
  zonectl --help       all commands
  candump vcan0        its wheels on the bus
  cat /tmp/zoned.log   what zoned said
  exit                 switch the robot off

TEXT
# Line editing; busybox's shell would prefer its own small ip.
echo "alias ip=/bin/ip; PS1='robot:\w# '" >/tmp/.profile
ENV=/tmp/.profile busybox sh
