# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# For tests that change the map of a robot while it drives; sourced with BIN SOURCE as arguments. The work folder is the
# current one, and goes when the test ends, with the robot.
set -euo pipefail
bin=$1 data=$2/tests/data config=$2/config/agilex.yaml
run=$data/scenario1_loop
work=$(mktemp -d)
trap 'kill %1 2>/dev/null && wait || true; rm -rf "$work"' EXIT
cd "$work"
export ZONED_SOCKET=$work/run/zoned.sock

fail() { echo "$*" >&2; cat out.txt >&2 || true; exit 1; }
holds() { jq -e "$2" "$1" >/dev/null || fail "$1 does not hold $2: $(cat "$1")"; }

drive() {  # BUDGET: the robot drives through the folder map, writing run.zpr, live.jsonl and live.json
  most=$1
  local privilege=()
  chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
  "$bin/zoned" run --config "$config" --map map --can "log:$run/can0.log@1" --corrections "$run/corrections.txt" \
    --budget "$most" --record run.zpr --events live.jsonl --json live.json "${privilege[@]}" >out.txt 2>&1 &
  pid=$!
}

until_status() {  # JQ-CONDITION: waits for it, and sees that the budget holds meanwhile
  for _ in $(seq 600); do
    if "$bin/zonectl" status --json status.json >/dev/null 2>&1; then
      (($(jq "[.charged_bytes, $most] | max" status.json) == most)) || fail "over the budget: $(cat status.json)"
      jq -e "$1" status.json >/dev/null && return 0
    fi
    kill -0 "$pid" 2>/dev/null || fail "the run ended before $1"
    sleep 0.05
  done
  fail "never $1: $(cat status.json)"
}

arrive() {  # stops the robot; its run keeps to the budget, and a replay of the recording is the same
  kill -TERM "$pid"
  wait "$pid" || fail "exit code $?"
  holds live.json ".budget_violations == 0 and .peak_charged_bytes <= $most and .lost_events == 0 and .allocations == 0"
  "$bin/zoned" replay --recording run.zpr --events again.jsonl --json again.json --report again.html >ctl.txt 2>&1 ||
    fail "$(cat ctl.txt)"
  cmp live.jsonl again.jsonl || fail "the replay differs"
  holds again.json ".budget_violations == 0 and .peak_charged_bytes <= $most"
}
