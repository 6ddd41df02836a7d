# SPDX-License-Identifier: Apache-2.0
# Cameras of a kernel hold what zoneloc asks of them, on the kernel's own virtual one (vivid); zoneloc streams from it
# next to zoned and shows the images it took in zonectl status, and a camera that is not there is refused by name.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
hold_contract video_device_contract
mkdir -p /run/zoned
zoned run --config "$config" --map /payload/map --can "log:$run/can0.log@1" --start 0,0,0 --allow-degraded >zoned.log 2>&1 &
pid=$!
wait_for serving
zoneloc run --camera v4l2:/dev/video99 --calibration /payload/loop/calibration.yaml >refused 2>&1 &&
  fail "a camera that is not there was not refused"
grep -q "/dev/video99" refused || fail "$(cat refused)"
zoneloc run --camera v4l2:/dev/video0 --calibration /payload/loop/calibration.yaml >zoneloc.log 2>&1 &
localizer=$!
images() { value status.json images; }
streams() { ask_status && [ "$(images)" -ge 5 ]; }
wait_for streams
kill -TERM $localizer
wait $localizer || fail "zoneloc ended with status $?: $(cat zoneloc.log)"
stop_zoned
echo "$contract zoneloc took $(images) images of /dev/video0, and found no pose in its bars"
