# SPDX-License-Identifier: Apache-2.0
# Sourced beside lib.sh: zoned started as its unit does, by the lines of the installed unit itself.
unit=/lib/systemd/system/zoned.service
user=64000
state=/data/lib/zoned

of_unit() { sed -n "s/^$1=//p" "$unit"; }

# Becomes a command line of the unit: an ordinary user, the unit's limits, in the control group $group.
as_unit() {  # KEY OPTION...
  echo 0 >"$group/cgroup.procs"
  ulimit -r "$(of_unit LimitRTPRIO)"
  ulimit -l "$(of_unit LimitMEMLOCK | sed s/infinity/unlimited/)"
  line=$(of_unit "$1")
  shift
  # shellcheck disable=SC2086
  exec start-stop-daemon -S -c "$user:$user" -x "${line%% *}" -- ${line#* } "$@"
}

# The settings of the package for this map and budget, the unit's folders, its memory limit (budget + 12 MiB as it
# says), its check and its command. Sets pid; zoned's words come in zoned.log.
start_unit() {  # BUDGET_BYTES OPTION...
  group=/sys/fs/cgroup/zoned
  rm -rf /run/zoned  # as RuntimeDirectory= does when a unit stops
  mkdir -p /etc/zonepack /run/zoned "$state" /data/out "$group"
  echo "zoned:x:$user:$user::/:/bin/sh" >/etc/passwd
  chown "$user:$user" /run/zoned "$state" /data/out
  sed -e 's|^  path: ""|  path: /payload/map|' -e "s|^  # budget: 24MiB|  budget: $1|" "$config" \
    >/etc/zonepack/zoned.yaml
  echo $(($1 + (12 << 20))) >$group/memory.max
  shift
  sysctl -q -p "${config%/*}/90-zoned.conf"
  export STATE_DIRECTORY=$state
  (as_unit ExecStartPre) >check.txt 2>&1 || fail "the unit's check: $(cat check.txt)"
  (as_unit ExecStart "$@") >zoned.log 2>&1 &
  pid=$!
  wait_for serving
}
