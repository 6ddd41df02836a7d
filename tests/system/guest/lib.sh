# SPDX-License-Identifier: Apache-2.0
# Sourced by the tests of this folder: POSIX sh, run as root on the virtual robot.
#
# A test is one file NAME_test.sh: a sentence in its comment, exit status 0 when it holds, and says in its last line
# of output what it found. It may need, in a line "# boot: OPTION...", one of toolchains/robot/boot.sh's options;
# tests with the same options share a boot, in order of their names, each in a new folder. A line
# "# not on FLAVOUR: WHY" tells that a kernel cannot run it. There are: zoned and can-utils, ip, gpiod's tools and
# busybox in PATH; /payload/data (tests/data without databases), /payload/map (the sample map), /payload/map2 (another
# version of it), /payload/budget (the smallest that map needs, in bytes), /payload/bin (contract tests),
# /payload/events.jsonl (what the host decided in the sample run). What a test leaves in /data/out goes to the host.
set -eu
data=/payload/data
run=$data/scenario1_loop
config=/usr/share/zonepack/config/agilex.yaml

fail() { echo "$*"; exit 1; }

# Waits until a command holds, at most 10 s.
wait_for() {
  tries=0
  until "$@"; do
    tries=$((tries + 1))
    [ $tries -le 200 ] || fail "not within 10 s: $*; $(cat zoned.log 2>&1)"
    sleep 0.05
  done
}

# A virtual CAN bus that takes classic and FD frames; new, whatever a test before left of that name.
vcan_up() {  # NAME
  ip link del "$1" 2>/dev/null || true
  ip link add "$1" type vcan
  ip link set "$1" mtu 72
  ip link set "$1" up
}

# Whether a program receives all frames of a bus.
listening() { grep -q "^ *$1 " /proc/net/can/rcvlist_all; }

# The arguments of the sample run, as tests/system/same_decisions_test.sh gives them.
replay_sample() {  # ARGUMENT...
  zoned replay --config "$config" --map /payload/map --can "$run/can0.log" --corrections "$run/corrections.txt" \
    --truth "$run/base_groundtruth.txt" --max-signatures 50 "$@" >/dev/null
}

# A number or word that a JSON file holds for a key.
value() {  # FILE KEY
  sed -n "s/.*\"$2\": *\([^,}]*\).*/\1/p" "$1" | head -1
}

holds() {  # FILE KEY VALUE
  [ "$(value "$1" "$2")" = "$3" ] || fail "$2 is $(value "$1" "$2"), not $3, in $(cat "$1")"
}

took() { sed -n "s/.*\"$2\": {.*\"$3\": \([0-9.]*\).*/\1/p" "$1"; }  # FILE cycle_us|wakeup_us p50|p99|p9999|max

zones_entered() {  # EVENTS
  sed -n 's/.*"event":"zone_entered","zone":"\([^"]*\)".*/\1/p' "$1"
}

# What zoned says of itself now; sets status.json.
ask_status() { zonectl status --json status.json; }
status_is() {  # KEY VALUE
  ask_status && [ "$(value status.json "$1")" = "$2" ]
}
said() { grep -q -- "$1" zoned.log; }
serving() { zonectl status >/dev/null 2>&1; }

stop_zoned() {
  kill -TERM "$pid"
  wait "$pid" || fail "zoned ended with status $?: $(cat zoned.log)"
}

# Runs a command in a control group of its own: in_cgroup NAME COMMAND...
in_cgroup() {
  sh -c 'echo $$ >"/sys/fs/cgroup/$1/cgroup.procs"; shift; exec "$@"' in_cgroup "$@"
}

# A chip of simulated lines. Sets chip (its name) and lines: $lines/sim_gpio3/value tells what line 3 is driven to,
# "pull-up" or "pull-down" written to $lines/sim_gpio3/pull drives it from outside. New, whatever a test before left.
gpio_sim() {  # LABEL COUNT
  sim=/sys/kernel/config/gpio-sim/$1
  if [ -e "$sim" ]; then
    echo 0 >"$sim/live"
    rmdir "$sim/bank0" "$sim"
  fi
  mkdir -p "$sim/bank0"
  echo "$2" >"$sim/bank0/num_lines"
  echo "$1" >"$sim/bank0/label"
  echo 1 >"$sim/live"
  chip=$(cat "$sim/bank0/chip_name")
  # shellcheck disable=SC2034  # for the tests
  lines=/sys/devices/platform/$(cat "$sim/dev_name")/$chip
}

# Ends the machine at once, as a power cut does: what only this kernel's memory held is lost. The host switches it on
# again with the same disk at /data, and this test begins anew; "# boot: disk" is needed.
cut_power() {
  echo POWER-CUT >/dev/console
  while :; do sleep 1; done
}

# Sends a hundred frames from can0 to can1, two controllers on one bus that are up, and compares.
send_hundred() {  # what stands between id and data in candump's logs: "#", or "##1" for FD with a fast data phase
  candump -L can1 >got &
  wait_for listening can1
  for i in $(seq 100 199); do
    cansend can0 "$i$1$i$i$i$i" || fail "frame $i was not sent"
    echo "$i${1%1}$i$i$i$i" >>sent
  done
  arrived() { [ "$(wc -l <got)" = 100 ]; }
  wait_for arrived
  cut -d' ' -f3 got | sed 's/##./##/' | cmp - sent || fail "the frames differ"
}

# Runs a contract of /payload/bin. Sets contract: how many of its tests passed, and those that were not run with the
# reasons. Fails where a test is left out for another reason than those that the call names.
hold_contract() {  # PROGRAM [REASON...]
  "/payload/bin/$1" >told 2>&1 || fail "the contract is broken: $(cat told)"
  shift
  contract="$(sed -n 's/.*PASSED *\] //p' told)"
  awk '/: Skipped$/ { getline; print }' told >left_out
  for reason in "$@"; do
    grep -qxF "$reason" left_out || fail "not left out: $reason"
    contract="$contract Not run, $reason."
  done
  [ "$(wc -l <left_out)" = $# ] && ! grep -q "NOT TESTED" told || fail "not tested: $(cat left_out)"
}

odometers() { grep -c ' 311#' "$1"; }  # LOG: frames that the settings let zoned take

centiseconds() {  # since power-on
  read -r up _ </proc/uptime
  echo $((${up%.*} * 100 + 1${up#*.} - 100))
}

# Plays a log of the sample drive into a bus, at the speed of its stamps, and gives zoned the drive's fixes meanwhile.
drive() {  # LOG BUS
  awk '!/^#/ { printf "%d %.4f %.4f %.3f\n", ($1 - 1718021600) * 100, $3, $4, $5 * 180 / 3.14159265 }' \
    "$run/corrections.txt" >fixes
  canplayer -I "$1" "$2=can0" &
  player=$!
  began=$(centiseconds)
  while read -r at x y yaw; do
    left=$((began + at - $(centiseconds)))
    [ $left -le 0 ] || sleep "$((left / 100)).$(printf %02d $((left % 100)))"
    kill -0 $player 2>/dev/null || break
    zonectl pose "$x" "$y" "$yaw" 0.03 >/dev/null || fail "zonectl pose $x $y $yaw"
  done <fixes
  wait $player || fail "canplayer: status $?"
}

# The first half minute of the sample drive, sent by can1, reaches zoned at can0, which still runs afterwards.
drive_between_controllers() {  # what stands before the data beside "#" in candump's logs
  awk -v more="$1" '/^\(/ { split($1, t, /[()]/); if (t[2] < 1718021630) { sub("#", "#" more); print } }' "$run/can0.log" >half
  frames=$(odometers half)
  zoned run --config "$config" --map /payload/map --can socketcan:can0 --events events.jsonl >zoned.log 2>&1 &
  pid=$!
  wait_for serving
  zonectl events >events &
  drive half can1
  wait_for status_is can_frames "$frames"
  zones_entered /payload/events.jsonl >expected
  sed -n 's/.*zone_entered *\([^ ]*\).*/\1/p' events >got_zones
  entered=$(wc -l <got_zones)
  [ "$entered" -ge 2 ] || fail "only $entered zones entered: $(cat events zoned.log)"
  head -n "$entered" expected | cmp - got_zones || fail "another route than the host's: $(cat got_zones)"
}
