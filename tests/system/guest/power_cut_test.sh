# SPDX-License-Identifier: Apache-2.0
# boot: disk
# A power cut keeps what was synced and renamed, and loses what was not: what tests of our own files stand on.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
if [ ! -e /data/kept ]; then
  echo whole >/data/new
  sync
  mv /data/new /data/kept
  sync
  echo half >/data/lost
  cut_power
fi
[ "$(cat /data/kept)" = whole ] || fail "what was synced is gone"
[ ! -s /data/lost ] || fail "the power was not cut: what was never synced is there"
echo "synced file kept, the other lost"
