# SPDX-License-Identifier: Apache-2.0
# boot: disk
# Power fails while another version of the map is copied beside the one in use, and again right after its manifest came:
# the robot starts with the old map, then with the new one, whole, where it was.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
state=/data/map-state
sed "s|^  folder: \"\"|  folder: $state|" "$config" >robot.yaml
run_map() {
  zoned run --config robot.yaml --map /data/map --can "log:$run/can0.log@200" --corrections "$run/corrections.txt" "$@"
}
is_map() { cmp -s /data/map/manifest.zpm "$1/manifest.zpm"; }
runs_whole() {  # after a power cut
  run_map --check >table || fail "$(cat table)"
  run_map --events events.jsonl --json result.json >zoned.log 2>&1 || fail "$(cat zoned.log)"
  if grep -q load_failed events.jsonl; then fail "zones cannot be loaded: $(cat zoned.log)"; fi
  sed -n 2p events.jsonl | grep -q '"event":"pose_initialised"' || fail "no pose from before: $(head -3 events.jsonl)"
  holds result.json budget_violations 0
}
copy_packs() {
  for pack in /payload/map2/*.zpk; do
    cp "$pack" "/data/map/.new" && mv /data/map/.new "/data/map/${pack##*/}"
  done
}
if [ ! -e /data/map/manifest.zpm ]; then
  mkdir -p /data/map
  cp /payload/map/* /data/map/
  run_map >zoned.log 2>&1 || fail "$(cat zoned.log)"
  sync
  while :; do run_map >/dev/null 2>&1; done &
  while :; do copy_packs; done &
  another() { [ "$(ls /data/map | wc -l)" -gt "$(ls /payload/map | wc -l)" ]; }
  wait_for another
  cut_power
elif is_map /payload/map; then
  runs_whole
  copy_packs
  sync  # packs first, and safe: rsync --fsync does it too
  while :; do run_map >/dev/null 2>&1; done &
  cp /payload/map2/manifest.zpm /data/map/.new
  sync
  mv /data/map/.new /data/map/manifest.zpm
  sync
  cut_power
fi
is_map /payload/map2 || fail "the manifest is neither the old nor the new one"
runs_whole
echo "old map after the first power cut, new map after the second: $(grep -c load_done events.jsonl) loads, none failed"
