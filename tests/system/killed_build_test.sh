#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A build that is killed leaves the map as it was, at whatever moment; prune takes its parts away; and
# what is built afterwards, on any number of jobs, is the same byte for byte.
# usage: killed_build_test.sh ZONEPACK TEST_DATA
set -euo pipefail
zonepack=$1 data=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "FAILED: $*" >&2; exit 1; }
build() { "$zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" "$@" >/dev/null 2>&1; }
# Checksums of the manifest in $1 and of the packs that it names.
fingerprint() {
  "$zonepack" inspect "$1" --json - 2>/dev/null | jq -r '.zones[].pack' | sort |
    (cd "$1" && xargs sha256sum -- manifest.zpm)
}

build --out "$work/map" --payload features
old=$(fingerprint "$work/map")
began=$(date +%s%N)
build --out "$work/new" --jobs 1
full_ns=$(($(date +%s%N) - began))

killed=0
for tenth in 1 2 3 4 5 6 7 8 9; do
  "$zonepack" build --db "$data/hospital-small.db" --zones "$data/zones.geojson" \
    --out "$work/map" --jobs 2 >/dev/null 2>&1 &
  process=$!
  # Not the same moment in every run: up to a tenth of the build later.
  wait_ns=$((full_ns * tenth / 20 + RANDOM * (full_ns / 20) / 32768))
  sleep "$((wait_ns / 1000000000)).$(printf %09d $((wait_ns % 1000000000)))"
  kill -KILL "$process" 2>/dev/null || true
  status=0
  wait "$process" 2>/dev/null || status=$?
  "$zonepack" verify "$work/map" >"$work/verdict" || { cat "$work/verdict"; fail "damaged after $tenth/20"; }
  if ((status == 137)) && [[ $(fingerprint "$work/map") == "$old" ]]; then
    killed=$((killed + 1))
  elif ((status == 0)); then
    # It was done first, and the new map stands; begin again from the old one.
    "$zonepack" prune "$work/map" >/dev/null
    build --out "$work/map" --payload features
  else
    [[ $(fingerprint "$work/map") == $(fingerprint "$work/new") ]] || fail "neither old nor new map, status $status"
    build --out "$work/map" --payload features
  fi
done
((killed >= 3)) || fail "only $killed of 9 builds were killed before they ended"

[[ $(fingerprint "$work/map") == "$old" ]] || fail "the old map changed"
"$zonepack" prune "$work/map" --dry-run >"$work/dry"
[[ $(fingerprint "$work/map") == "$old" ]] || fail "prune --dry-run changed the map"
"$zonepack" prune "$work/map" >"$work/pruned"
[[ $(sed 's/would remove/removed/; /to remove$\|removed$/d' "$work/dry") == \
   $(sed '/to remove$\|removed$/d' "$work/pruned") ]] || fail "prune removed other files than --dry-run listed"
# The manifest and one pack for each zone: nothing else is left.
zones=$("$zonepack" inspect "$work/map" --json - 2>/dev/null | jq '.zones | length')
files=$(find "$work/map" -type f | wc -l)
((files == zones + 1)) || fail "$files files for $zones zones after prune"
[[ $(fingerprint "$work/map") == "$old" ]] || fail "prune changed the map"
"$zonepack" verify "$work/map" >/dev/null || fail "damaged by prune"

for jobs in 1 2 5; do
  build --out "$work/map" --jobs "$jobs"
  "$zonepack" prune "$work/map" >/dev/null
  diff -r "$work/new" "$work/map" || fail "--jobs $jobs gives other bytes"
  build --out "$work/map" --payload features
done
echo "$killed of 9 builds killed, the old map whole each time; the same bytes on 1, 2 and 5 jobs"
