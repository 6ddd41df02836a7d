# SPDX-License-Identifier: Apache-2.0
# boot: disk
# Power fails three times while zoned runs again and again and writes its state: each time the next run begins where
# the robot was, as a guess, from a state that is whole and not older than one that was seen before.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
state=/data/state
sed "s|^  folder: \"\"|  folder: $state|" "$config" >robot.yaml
run_again() {
  zoned run --config robot.yaml --map /payload/map --can "log:$run/can0.log@200" --corrections "$run/corrections.txt" "$@"
}
newest() {  # the highest sequence number of the state's files
  for file in "$state"/state-?; do od -An -tu8 -j24 -N8 "$file"; done | sort -n | tail -1 | tr -d ' '
}
cuts=$(cat /data/cuts 2>/dev/null || echo 0)
if [ "$cuts" -gt 0 ]; then
  seen=$(cat /data/seen)
  [ "$(newest)" -ge "$seen" ] || fail "state $(newest) after power cut $cuts, $seen was seen before"
  run_again --events first.jsonl >zoned.log 2>&1 || fail "cut $cuts: $(cat zoned.log)"
  if said "$state"; then fail "cut $cuts: $(cat zoned.log)"; fi
  begun=$(sed -n '/"cycle":0,.*"pose_initialised"/s/.*"x_mm":\(-*[0-9]*\),"y_mm":\(-*[0-9]*\).*/\1 \2/p' first.jsonl)
  [ -n "$begun" ] || fail "cut $cuts: no pose from before: $(head -3 first.jsonl)"
  # The pose is one of the drive: within half a metre of where the robot truly was at some time.
  awk -v at="$begun" 'BEGIN { split(at, p) }
    !/^#/ { x = $2 - p[1] / 1000; y = $3 - p[2] / 1000; if (x * x + y * y < 0.25) near = 1 }
    END { exit !near }' "$run/base_groundtruth.txt" || fail "cut $cuts: began at $begun mm, off the drive"
fi
if [ "$cuts" -lt 3 ]; then
  echo $((cuts + 1)) >/data/cuts
  while :; do run_again >/dev/null 2>&1; done &
  before=$(newest 2>/dev/null || echo 0)
  saved_again() { [ "$(newest 2>/dev/null)" -gt $((${before:-0} + 3)) ] 2>/dev/null; }
  wait_for saved_again
  newest >/data/seen
  sync
  cut_power
fi
echo "3 power cuts, state $(newest): each run began where the robot was, the last one at $begun mm"
