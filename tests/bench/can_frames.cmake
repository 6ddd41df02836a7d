# SPDX-License-Identifier: Apache-2.0
# Run on the virtual robot, whose kernel has a CAN bus: tests/system/guest/can_frames_test.sh.
zonepack_measurement(can_frames.cpp zonepack_core)
