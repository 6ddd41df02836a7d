#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: killed_update_test.sh ZONEPACK TEST_DATA: an update that is killed or cannot write leaves the map as it was, at
# whatever moment; the next one clears away what was half-written, and makes the same map byte for byte.
set -euo pipefail
zonepack=$1 data=$2
work=$(mktemp -d)
trap 'umount "$work/disk" 2>/dev/null || true; rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAILED: $*" >&2; exit 1; }
update() { "$zonepack" update "$@" --db grown.db --add; }
# Checksums of the manifest in $1 and of the packs that it names.
fingerprint() {
  "$zonepack" inspect "$1" --json - 2>/dev/null | jq -r '.zones[].pack' | sort | (cd "$1" && xargs sha256sum -- manifest.zpm)
}
whole() { "$zonepack" verify "$1" >verdict || { cat verdict; fail "damaged $2"; }; }
files() { find "$1" -type f -printf '%f\n' | sort; }

cp "$data/hospital-small.db" grown.db && chmod u+w grown.db
cp grown.db skeleton.db
sqlite3 skeleton.db "delete from Link where from_id > 92 or to_id > 92; delete from Feature where node_id > 92;
  delete from Data where id > 92; delete from Node where id > 92"
"$zonepack" build --db skeleton.db --zones "$data/zones.geojson" --out old >/dev/null 2>&1
old=$(fingerprint old)
cp -r old new
began=$(date +%s%N)
update new --jobs 1 >/dev/null 2>&1
full_ns=$(($(date +%s%N) - began))
new=$(fingerprint new)
[[ $new != "$old" ]] || fail "the update changes nothing"

# Killed.
cp -r old map
killed=0 parts=0
for twelfth in $(seq 1 12); do
  "$zonepack" update map --db grown.db --add --jobs 2 >/dev/null 2>&1 &  # itself, not a shell around it
  process=$!
  # Not the same moment in every run: up to a fourteenth of the update later.
  wait_ns=$((full_ns * twelfth / 14 + RANDOM * (full_ns / 14) / 32768))
  sleep "$((wait_ns / 1000000000)).$(printf %09d $((wait_ns % 1000000000)))"
  kill -KILL "$process" 2>/dev/null || true
  status=0
  wait "$process" 2>/dev/null || status=$?
  whole map "after $twelfth/14"
  now=$(fingerprint map)
  parts=$((parts + $(files map | grep -c '\.part-' || true)))
  if [[ $now == "$old" ]] && ((status == 137)); then
    killed=$((killed + 1))
  else
    [[ $now == "$new" ]] || fail "neither the old nor the new map, status $status"
    rm -rf map && cp -r old map
  fi
done
((killed >= 3)) || fail "only $killed of 12 updates were killed before they ended"
# What a killed one leaves at the worst moment, and a part of a process that still runs.
echo half >map/manifest.zpm.part-99999999-1
echo half >map/C2-0123456789abcdef.zpk.part-99999999-2
echo written >"map/R51-0123456789abcdef.zpk.part-$$-1"
update map >/dev/null 2>&1
[[ $(files map | grep '\.part-') == "R51-0123456789abcdef.zpk.part-$$-1" ]] || fail "half-written files stay: $(files map)"
rm map/*.part-*
[[ $(fingerprint map) == "$new" ]] || fail "another map after kills"
"$zonepack" prune map >/dev/null
cp -r new pruned && "$zonepack" prune pruned >/dev/null
diff -r pruned map || fail "more is left than the new map"

# A file may not grow over a limit: some packs can be written, then one cannot.
largest=$(find new -type f -printf '%s\n' | sort -n | tail -1)
rm -rf map && cp -r old map
for kib in 0 1 $((largest / 4096)) $((largest / 2048)) $((largest / 1024 - 1)); do
  status=0
  (ulimit -f "$kib"; update map 2>&1 >/dev/null) | cat >err.txt || status=$?  # a pipe has no limit
  ((status == 1)) || fail "under a limit of $kib KiB: status $status: $(cat err.txt)"
  grep -q '^zonepack: map.*: File too large' err.txt || fail "under a limit of $kib KiB: $(cat err.txt)"
  diff -r old map || fail "a limit of $kib KiB leaves another map"
done
update map >/dev/null 2>&1
[[ $(fingerprint map) == "$new" ]] || fail "another map after limits"

# A full disk, from one without any room to one with too little for the manifest only.
mkdir disk
if mount -t tmpfs -o size=64m none disk 2>/dev/null; then
  bytes() { du -sB1 --apparent-size "$1" | cut -f1; }
  written=$(($(bytes new) - $(bytes old)))
  cp -r old disk/map
  room=$(($(stat -f -c '(%b - %f) * %S' disk)))
  full=0
  for share in 0 30 60 90 99; do
    mount -o remount,size=$(((room + written * share / 100 + 4095) / 4096 * 4096)) disk
    status=0
    update disk/map >out.txt 2>err.txt || status=$?
    ((status == 1)) || fail "with room for $share %: status $status: $(cat err.txt)"
    grep -q '^zonepack: disk/map.*: No space left on device' err.txt || fail "with room for $share %: $(cat err.txt)"
    diff -r old disk/map || fail "a disk with room for $share % leaves another map"
    full=$((full + 1))
  done
  mount -o remount,size=64m disk
  update disk/map >/dev/null 2>&1
  [[ $(fingerprint disk/map) == "$new" ]] || fail "another map after a full disk"
  echo "$full updates on a full disk"
else
  echo "not run: an update on a full disk, which needs the right to mount"
fi
echo "$killed of 12 updates killed, $parts half-written files cleared away; the old map whole each time"
