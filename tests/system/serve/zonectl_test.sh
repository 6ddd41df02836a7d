#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: zonectl_test.sh BIN SOURCE: every command of zonectl as a user gives it, against a made-up run.
set -euo pipefail
bin=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export ZONED_SOCKET=$work/zoned.sock
failed=0
# check NAME EXIT PATTERN COMMAND...: the exit code, and a pattern in what it says.
check() {
  local name=$1 code=$2 pattern=$3 got=0
  shift 3
  "$@" >"$work/out" 2>&1 || got=$?
  if [ "$got" != "$code" ] || { [ -n "$pattern" ] && ! grep -qE -e "$pattern" "$work/out"; }; then
    echo "$name: exit $got, expected $code and /$pattern/:"
    cat "$work/out"
    failed=1
  fi
}
zonectl=$bin/zonectl

check 'nobody listens' 1 "$ZONED_SOCKET: no zoned listens there; start zoned run" "$zonectl" status
check 'no command' 2 'subcommand' "$zonectl"
check 'no such command' 2 '' "$zonectl" dance
check 'not a number' 2 'X' "$zonectl" pose here 0 0

coproc run { exec "$bin/made_up_run" "$ZONED_SOCKET"; }
read -r ready <&"${run[0]}"
[ "$ready" = ready ]

check 'status' 0 '^NOT KEEPING UP: the robot is in a, ' "$zonectl" status
check 'status counts' 0 '^not_keeping_up +1$' "$zonectl" status
check 'status as JSON' 0 '^\{"zone":"a",.*"budget_bytes":8388608,' "$zonectl" status --json -
"$zonectl" status --json "$work/status.json"
jq -e '.not_keeping_up == 1 and .zones == 3' "$work/status.json" >/dev/null
check 'zones' 0 '^b +resident +wanted ' "$zonectl" zones
check 'metrics' 0 '^zoned_not_keeping_up_total 1$' "$zonectl" metrics
check 'zones in a table' 0 '^b +resident .* 32[.0-9]* KiB ' "$zonectl" zones
zones_are() {  # NAME COMMAND...: one document of three zones, b resident and loaded once
  local name=$1
  shift
  "$@" >"$work/out" 2>&1 || true
  jq -se 'length == 1 and (.[0].zones | length == 3 and .[1].zone == "b" and .[1].state == "resident" and
      .[1].loads == 1 and .[1].wanted and (.[0].last_load_s | not) and .[1].last_load_s == 0)' \
    "$work/out" >/dev/null || { echo "$name: $(cat "$work/out")"; failed=1; }
}
zones_are 'zones as JSON' "$zonectl" zones --json
zones_are 'zones as JSON to -' "$zonectl" zones --json -
zones_are 'an option before the subcommand' "$zonectl" --json zones
"$zonectl" zones --json "$work/zones.json"
zones_are 'zones into a file' cat "$work/zones.json"
env -u ZONED_SOCKET "$zonectl" zones --socket "$ZONED_SOCKET" --json >"$work/zones.json"
zones_are 'an option of the program after the subcommand' cat "$work/zones.json"
check 'metrics of the build' 0 '^zoned_build_info.version="[^"]+",commit="[^"]+",protocol="1",.* 1$' "$zonectl" metrics
check 'metrics of a zone' 0 '^zoned_zone_loads_total.zone="b",type="room". 1$' "$zonectl" metrics
"$zonectl" metrics >"$work/metrics"
python3 "$source/tests/system/serve/dashboard_test.py" "$source/config/grafana.json" "$work/metrics" || failed=1
check 'pin' 0 '' "$zonectl" pin b
check 'pinned' 0 '^b +resident +wanted pinned ' "$zonectl" zones
check 'unpin' 0 '' "$zonectl" unpin b
check 'no room' 1 '^zonectl: no room besides the pins' "$zonectl" pin c
check 'no such zone' 1 '^zonectl: not found: no zone "x" in this map' "$zonectl" pin x
check 'freeze' 0 '' "$zonectl" freeze
check 'unfreeze' 0 '' "$zonectl" unfreeze
check 'pose' 0 '' "$zonectl" pose -1.5 2 -90 0.2
check 'route' 0 '^b  door at 8.00 2.00$' "$zonectl" route a c
check 'route length' 0 '^4.0 m$' "$zonectl" route a c
check 'route from here' 0 '^7.0 m, handed to preload$' "$zonectl" route . c --hint
for words in 'a c --json' '--json a c' 'a --json c' 'a c --json -'; do
  # shellcheck disable=SC2086  # words
  "$zonectl" route $words >"$work/out" 2>&1 || true
  jq -se 'length == 1 and (.[0] | .length_m == 4 and .zones == ["a","b","c"] and .doors[1] == {x_m: 8, y_m: 2}
      and .hinted == false)' "$work/out" >/dev/null || { echo "route $words: $(cat "$work/out")"; failed=1; }
done
check 'route to nowhere' 2 'TO is required' "$zonectl" route a
check 'JSON of what has none' 2 '' "$zonectl" pin b --json
check 'dump' 0 ': 6 bytes$' "$zonectl" dump "$work/recording"
[ "$(cat "$work/recording")" = frames ]
check 'dump into nowhere' 1 'cannot be written' "$zonectl" dump "$work/no/folder"
check 'events' 0 'zone_wanted b$' timeout -k 60 --preserve-status 3 "$zonectl" events
timeout -k 60 --preserve-status 3 "$zonectl" events --json >"$work/events.jsonl" || failed=1
jq -se 'length > 0 and all(.event == "zone_wanted" and .zone == "b" and has("cycle") and has("charged_bytes"))' \
  "$work/events.jsonl" >/dev/null || { echo "events as JSON: $(head -3 "$work/events.jsonl")"; failed=1; }
check 'events into nowhere' 1 'cannot be written' "$zonectl" events --json "$work/no/events"
check 'watch without a terminal' 0 '^in a  x 1.00  y 2.00 m .* NOT KEEPING UP' \
  timeout -k 60 --preserve-status 3 "$zonectl" watch
# In a terminal: pictures until interrupted, and the terminal as it was before.
TERM=xterm script -qefc "exec '$zonectl' watch" "$work/seen" >/dev/null 2>&1 &
watching=$!
for ((tries = 0; tries < 600; tries++)); do
  if grep -qs 'in a' "$work/seen"; then break; fi
  sleep 0.1
done
pkill -INT -P $watching
for ((tries = 0; tries < 600; tries++)); do
  if ! kill -0 $watching 2>/dev/null; then break; fi
  sleep 0.1
done
if pkill -KILL -P $watching; then echo 'watch: still there a minute after SIGINT'; failed=1; fi
if kill -KILL $watching 2>/dev/null; then echo 'watch: script outlived it by a minute'; failed=1; fi
got=0
wait $watching || got=$?
[ $got = 0 ] || { echo "watch: exit $got when interrupted, expected 0"; failed=1; }
grep -qF $'\x1b[?1049h' "$work/seen" || { echo 'watch: no picture'; failed=1; }
tail -n +2 "$work/seen" | tr -d '\r' | grep -qF $'\x1b[?1049l' || { echo 'watch: the terminal was left changed'; failed=1; }
# shellcheck disable=SC2154  # set by coproc
pid=$run_PID
eval "exec ${run[1]}>&-"
wait "$pid"
check 'gone' 1 'no zoned listens there' "$zonectl" metrics
exit $failed
