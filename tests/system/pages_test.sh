#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: pages_test.sh BIN SOURCE: the manual pages and completions in toolchains/deb are those of the programs in BIN;
# the pages are sound, and bash completes commands, options, files and folders.
set -euo pipefail
bin=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

python3 "$source/toolchains/deb/pages.py" "$bin" "$work/made"
for folder in man completions; do
  diff -r "$source/toolchains/deb/$folder" "$work/made/$folder" ||
    { echo "toolchains/deb/$folder is not what the programs say: run toolchains/deb/pages.py BIN toolchains/deb"; exit 1; }
done
mandoc -T lint -W error "$source"/toolchains/deb/man/*.1

mkdir "$work/here" "$work/here/map"
touch "$work/here/map.db" "$work/here/zones.geojson"
cd "$work/here"
completes() {  # EXPECTED WORD...: the last word is the one being typed; EXPECTED is in order of the alphabet
  local expected=$1 COMP_WORDS=("${@:2}") COMP_CWORD=$(($# - 2)) COMPREPLY=()
  "_$2"
  mapfile -t COMPREPLY < <(printf '%s\n' "${COMPREPLY[@]}" | sort)
  [ "${COMPREPLY[*]}" = "$expected" ] || { echo "${*:2}: expected '$expected', got '${COMPREPLY[*]}'"; exit 1; }
}
for program in zonepack zoned zonectl zoneloc; do
  # shellcheck disable=SC1090
  . "$source/toolchains/deb/completions/$program"
done
completes "replay" zoned rep
completes "--map --max-signatures" zoned replay --ma
completes "map map.db" zonepack build --db map
completes "map" zoned replay --map m
completes "zones.geojson" zonepack check-zones zon
completes "pin" zonectl pi
completes "--sigma-yaw" zonectl --socket x pose --sigma
completes "" zonectl pose --sigma-yaw 0
echo "pages: as the programs say"
