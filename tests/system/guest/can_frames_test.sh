# SPDX-License-Identifier: Apache-2.0
# Frames a second that a control thread takes at 1 kHz without loss, beside candump on the same bus.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
vcan_up vcan0
/payload/bin/can_frames vcan0 >told || fail "$(cat told)"
grep -q '^candump: [0-9]' told || fail "candump was not measured"
tail -2 told | tr '\n' ' '
echo
