#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: console_test.sh BIN SOURCE: what zoned run prints, where it serves, and which outputs it refuses before it starts.
set -euo pipefail
bin=$1 source=$2 data=$2/tests/data
mission=$data/scenario1_loop
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/run/zoned.sock

fail() { echo "$*" >&2; exit 1; }
says() { grep -q -- "$1" err.txt || fail "no word of '$1' in: $(cat err.txt)"; }
exits() {  # CODE COMMAND...: its output in out.txt and err.txt
  local want=$1 got=0
  shift
  timeout 60 "$@" >out.txt 2>err.txt || got=$?
  ((got == want)) || fail "$*: exit code $got, not $want: $(cat err.txt)"
}
"$bin/zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" --out map --payload features \
  >/dev/null 2>&1
what=(--config "$source/config/agilex.yaml" --map map --allow-degraded)
play=(run "${what[@]}" --can "log:$mission/can0.log@200" --corrections "$mission/corrections.txt")

# A line for what happens to each zone; a warning only when quiet.
exits 0 "$bin/zoned" "${play[@]}" --budget 1MiB --events events.jsonl
says '^zoned: [0-9.]* s: zone L1 entered$'
says '^zoned: [0-9.]* s: zone L1 loaded: 31 signatures, .* in [0-9]* ms; .* of 1.00 MiB charged$'
says '^zoned: [0-9.]* s: zone .* evicted: '
says '^zoned: [0-9.]* s: fix refused: outlier$'
says '^zoned: [0-9.]* s: map ready: the robot is in zone L1$'
for pair in 'zone_entered entered$' 'load_done loaded:' 'evicted evicted:'; do
  read -r event word <<<"$pair"
  events=$(grep -c "\"event\":\"$event\"" events.jsonl) || true
  lines=$(grep -c "s: zone [A-Z0-9]* $word" err.txt) || true
  ((events > 0 && events == lines)) || fail "$events events $event, $lines lines: $(cat err.txt)"
done
exits 0 "$bin/zoned" "${play[@]}" --budget 1MiB --quiet
! grep -qE 'entered$|loaded:|evicted:|fix refused|map ready' err.txt || fail "not quiet: $(cat err.txt)"
grep -q -- '--quiet' "$source/config/zoned.service" || fail "the service is not quiet"

# The events on standard output, whole and with the same hash as in a file; the table goes elsewhere.
exits 0 "$bin/zoned" "${play[@]}" --quiet --events -
jq -se '.[0].event == "start" and .[-1].event == "end"' out.txt >/dev/null || fail "events: $(head -3 out.txt)"
says "$(b2sum -l 256 out.txt | cut -d' ' -f1)"
replay=(replay --config "$source/config/agilex.yaml" --map map --can "$mission/can0.log" --corrections "$mission/corrections.txt")
exits 0 "$bin/zoned" "${replay[@]}" --events - --json run.json
[ "$(jq -r .event_log_hash run.json)" = "$(b2sum -l 256 out.txt | cut -d' ' -f1)" ] || fail "replay --events -: hash"
exits 2 "$bin/zoned" "${replay[@]}" --events - --json -
says 'standard output takes one of them'

# Outputs that cannot be written are refused before the run, all at once.
exits 1 "$bin/zoned" "${play[@]}" --json no/run.json --record-can "$work" --events events.jsonl
says '--json: no/run.json: cannot be written: there is no folder no; mkdir -p no'
says "--record-can: $work: cannot be written"
! grep -q 'zone L1' err.txt || fail "the run started: $(cat err.txt)"
exits 1 "$bin/zoned" "${replay[@]}" --report no/run.html
says '--report: no/run.html: cannot be written'
[ ! -s out.txt ] || fail "the replay was made: $(cat out.txt)"

# A pipe that nobody reads is refused in time; one that is read is written to.
mkfifo pipe
for option in --events --record-can; do
  began=$SECONDS
  exits 1 "$bin/zoned" "${play[@]}" "$option" pipe
  says "pipe: cannot be written: .*nobody reads it"
  ((SECONDS - began < 20)) || fail "$option: refused after $((SECONDS - began)) s"
done
cat pipe >read.jsonl &
exits 0 "$bin/zoned" "${play[@]}" --quiet --events pipe
wait
tail -1 read.jsonl | grep -q '"event":"end"' || fail "a pipe that is read gets no events"

# Where it serves: --socket, then ZONED_SOCKET, then the settings; refused where no socket can be made.
serves() {  # SOCKET OPTION...: zoned answers there, then ends
  local socket=$1
  shift
  "$bin/zoned" run "${what[@]}" --can "log:$mission/can0.log@1" --corrections "$mission/corrections.txt" --quiet "$@" \
    >out.txt 2>err.txt &
  local zoned=$!
  for _ in $(seq 200); do
    [ -S "$socket" ] && break
    sleep 0.05
  done
  "$bin/zonectl" --socket "$socket" status >ctl.txt 2>&1 || fail "$socket: $(cat ctl.txt err.txt)"
  [ -z "${group:-}" ] || [ "$(stat -c '%G %a' "$socket")" = "$group" ] || fail "$(stat -c '%G %a' "$socket"), not $group"
  kill -TERM $zoned
  wait $zoned || fail "exit code $?: $(cat err.txt)"
}
mkdir elsewhere
serves "$work/elsewhere/z" --socket "$work/elsewhere/z"
serves "$ZONED_SOCKET"
exits 1 "$bin/zoned" "${play[@]}" --socket "$work/no/such/folder/z"
says "no/such/folder"
says "nobody can be served"
says "--socket"
exits 0 "$bin/zoned" "${play[@]}" --quiet --socket ""
exits 1 "$bin/zoned" "${play[@]}" --socket /proc/z
says "/proc/z"

# The group of the socket's file.
sed 's|^  group: ""|  group: no-such-group|' "$source/config/agilex.yaml" >grouped.yaml
what=(--config grouped.yaml --map map --allow-degraded)
exits 1 "$bin/zoned" run "${what[@]}" --can "log:$mission/can0.log@200"
says 'group "no-such-group": there is no such group'
if [ "$(id -u)" = 0 ]; then
  sed -i 's|no-such-group|daemon|' grouped.yaml
  group='daemon 660' serves "$ZONED_SOCKET"
fi

# Options may stand on either side of the subcommand.
exits 0 "$bin/zoned" --quiet --budget 4MiB "${play[@]}"

# Every help ends with examples, whose commands are understood: without the files that they name, each fails for what it
# lacks (1), not for how it is written (2).
mkdir empty
cd empty
export ZONED_SOCKET=$work/nobody
programs=(zoned zonectl)
if [ -x "$bin/zoneloc" ]; then programs+=(zoneloc); fi
for program in "${programs[@]}"; do
  commands=$("$bin/$program" --help | sed -n '/^Subcommands:/,/^Examples:/s/^  \([a-z]\+\) .*/\1/p')
  [ "$(wc -w <<<"$commands")" -ge 3 ] || fail "$program: no subcommands in its help"
  for command in '' $commands; do
    # shellcheck disable=SC2086  # an empty one is none
    "$bin/$program" $command --help >../help.txt
    examples=$(sed -n '/^Examples:/,$p' ../help.txt | tail -n +2 | sed -e ':a' -e '/\\$/N; s/\\\n *//; ta')
    [ -n "$examples" ] || fail "$program $command --help: no examples"
    while read -r name arguments; do
      [ "$name" = "$program" ] || fail "$program $command --help: an example of $name"
      got=0
      # shellcheck disable=SC2086  # words of a command
      timeout 60 "$bin/$name" ${arguments//\/run\/zoned/\/nowhere} >../out.txt 2>&1 || got=$?
      ((got == 1)) || fail "example '$name $arguments': exit code $got, not 1: $(cat ../out.txt)"
    done <<<"$examples"
  done
done
echo "zoned says what it does, serves where it should, and refuses early"
