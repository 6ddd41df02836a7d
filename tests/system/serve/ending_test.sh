#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: ending_test.sh BIN SOURCE: zoned ends in time whatever hangs, each output fails alone, and nothing that takes
# the place of its own files is followed or waited for.
set -euo pipefail
bin=$1 source=$2 data=$2/tests/data
mission=$data/scenario1_loop
work=$(mktemp -d)
zoned=
trap '[ -z "$zoned" ] || kill -KILL "$zoned" 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/zoned.sock

fail() { echo "$*" >&2; exit 1; }
says() { grep -q -- "$1" err.txt || fail "no word of '$1' in: $(cat err.txt)"; }
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map --payload features \
  >/dev/null 2>&1
sed 's|^  folder: ""|  folder: state|' "$source/config/agilex.yaml" >robot.yaml

start() {  # ARGUMENTS...: zoned in the background, until it serves
  "$bin/zoned" run --config robot.yaml --map map --can "log:$mission/can0.log@1" --corrections "$mission/corrections.txt" \
    --allow-degraded "$@" >out.txt 2>err.txt &
  zoned=$!
  for _ in $(seq 200); do
    [ -S "$ZONED_SOCKET" ] && return
    sleep 0.05
  done
  fail "zoned does not serve: $(cat err.txt)"
}
ends() {  # CODE SECONDS: zoned gets SIGTERM and ends with the code within the time
  local code=0 began=$SECONDS
  kill -TERM "$zoned"
  for _ in $(seq $(($2 * 20))); do
    kill -0 "$zoned" 2>/dev/null || break
    sleep 0.05
  done
  kill -0 "$zoned" 2>/dev/null && fail "zoned still runs $2 s after SIGTERM"
  wait "$zoned" || code=$?
  zoned=
  ((code == $1)) || fail "exit code $code, not $1, after $((SECONDS - began)) s: $(cat err.txt)"
  [ ! -e "$ZONED_SOCKET" ] || fail "the socket is left"
}

full_pipe() {  # a new one, filled to the brim, that this script keeps open as 3
  exec 3>&-
  rm -f pipe
  mkfifo pipe
  exec 3<>pipe
  python3 -c "
import os
fd = os.open('pipe', os.O_RDWR | os.O_NONBLOCK)
try:
    while True: os.write(fd, b'x' * 4096)
except BlockingIOError: pass"
}

# A recording into a pipe that nobody reads: everything else is written, and all is well.
full_pipe
start --events events.jsonl --json run.json
"$bin/zonectl" dump pipe >/dev/null 2>&1 &
asking=$!
sleep 2
ends 0 5
wait "$asking" || true
grep -q '"event":"end"' events.jsonl || fail "the events are not whole"
grep -q event_log_hash run.json || fail "no summary"

# The log thread hangs in a write: the rest is given up, by name.
full_pipe
start --record-can pipe
sleep 3
ends 1 9
says "without waiting longer for the thread that writes --events"

# The thread that reads the log hangs in a pipe.
exec 3>&-
rm pipe
mkfifo pipe
head -200 "$mission/can0.log" >first.log
(cat first.log; sleep 30) >pipe &
feeding=$!
"$bin/zoned" run --config robot.yaml --map map --can "log:$work/pipe@1" --allow-degraded >out.txt 2>err.txt &
zoned=$!
sleep 3
ends 1 9
says "without waiting longer for the source of frames"
kill "$feeding" 2>/dev/null || true

# Each thread in turn stands still, as in a system call that does not return.
while read -r thread words; do
  rm -f run.json
  start --json run.json
  "$bin/hold_thread" "$zoned" "$thread" 60 &
  holding=$!
  sleep 0.5
  ends 1 9
  says "without waiting longer for $words"
  wait "$holding" || fail "hold_thread $thread: exit code $?"
done <<'THREADS'
zoned-loader the thread that loads zones
zoned-log the thread that writes --events
zoned-state the thread that writes --events, --record and --record-can, or the state
zoned-feed the source of frames
zoned-service the thread that serves clients
zoned-control the control thread
THREADS

# So does the thread that takes a new version of the map, which lives as long as that takes.
start --json run.json --budget 8MiB
"$bin/hold_thread" "$zoned" zoned-map 60 &
holding=$!
sleep 0.5
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map --payload features \
  --max-zone-bytes 300KiB >/dev/null 2>&1
kill -HUP "$zoned"
sleep 1
ends 1 9
says "without waiting longer for the thread that reads a new version of the map"
wait "$holding" || fail "hold_thread zoned-map: exit code $?"

# The saved state's folder and the flight recorder do not follow or wait for what is not theirs.
rm -rf state && mkdir state
echo precious >target
ln -s "$work/target" state/state-0
mkfifo state/state-1
start --json run.json
sleep 1
ends 0 5
says "state-0: is a symbolic link"
says "state-1: is a FIFO"
[ "$(cat target)" = precious ] || fail "the target of a link was written to"
rm -rf state

# The lock's place is taken: the run is refused, and the message says by what.
rm -f zoned.lock && mkfifo zoned.lock
code=0
timeout 60 "$bin/zoned" run --config robot.yaml --map map --can "log:$work/first.log@100000" --allow-degraded \
  >out.txt 2>err.txt || code=$?
((code == 1)) || fail "exit code $code, not 1: $(cat err.txt)"
says "nobody can be served: .*zoned.lock: is a FIFO"
rm zoned.lock

# A full disk under some outputs loses the others nothing; all are named.
play() {
  "$bin/zoned" run --config robot.yaml --map map --can "log:$mission/can0.log@100000" \
    --corrections "$mission/corrections.txt" --allow-degraded "$@" >out.txt 2>err.txt
}
code=0
rm -f events.jsonl run.json
ln -s /dev/full full
play --record-can /dev/full --events "$work/full" --json run.json --record run.zpr || code=$?
((code == 1)) || fail "exit code $code, not 1: $(cat err.txt)"
says "/dev/full: cannot be written: No space left"
says "$work/full: cannot be written: No space left"
grep -q event_log_hash run.json || fail "--json was lost too"
"$bin/zoned" replay --recording run.zpr --events events.jsonl >/dev/null 2>&1 || fail "--record was lost too"
code=0
"$bin/zoned" replay --config robot.yaml --map map --can "$mission/can0.log" --corrections "$mission/corrections.txt" \
  --events /dev/full --json again.json --report report.svg >out.txt 2>err.txt || code=$?
((code == 1)) || fail "replay: exit code $code, not 1: $(cat err.txt)"
says "/dev/full: cannot be written"
[ -s again.json ] && [ -s report.svg ] || fail "replay lost its other outputs"

# A limit on the size of files is an error of what was to be written. It counts for shared memory too, so the log must
# be longer than that: eight turns of the drive are 4 MB.
for turn in 0 1 2 3 4 5 6 7; do
  awk -F'[()]' -v by=$((turn * 300)) '{ printf "(%.6f)%s\n", $2 + by, $3 }' "$mission/can0.log"
done >eight.log
rm -f run.json
code=0
(
  ulimit -f 2048  # KiB
  "$bin/zoned" run --config robot.yaml --map map --can "log:eight.log@100000" --start 0,0,0 --allow-degraded \
    --record-can large.log --json run.json >out.txt 2>err.txt
) || code=$?
((code == 1)) || fail "exit code $code, not 1, at ulimit -f: $(cat err.txt)"
says "large.log: cannot be written: File too large"
grep -q event_log_hash run.json || fail "--json was lost at ulimit -f"
