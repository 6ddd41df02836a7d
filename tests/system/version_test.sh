#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: version_test.sh BIN SOURCE VERSION: what programs print for --version, and how the commit in it is found.
set -euo pipefail
bin=$1 source=$2 version=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

in_document() {  # FILE PATTERN: the version that the document of a format states
  sed -nE "s/.*$2 ([0-9]+(\.[0-9]+)?)[.;,\` ].*/\1/p" "$source/$1" | head -1
}
pack="pack format $(in_document runtime/pack_format/FORMAT.md '^Version')"
recording="recording format $(in_document runtime/recording/RECORDING.md 'This page [a-z]+ version')"
protocol="protocol $(in_document runtime/protocol/PROTOCOL.md '.version.')"
expect() {  # PROGRAM FORMATS
  local line
  line=$("$bin/$1" --version)
  [[ $line =~ ^"$1 $version (commit "([0-9a-f]{12}(-dirty)?|unknown)", $2)"$ ]] ||
    { echo "$1 --version prints '$line', expected '$1 $version (commit COMMIT, $2)'"; exit 1; }
}
expect zonepack "$pack"
expect zoned "$pack, $recording"
expect zonectl "$protocol"
expect zoneloc "$pack, $protocol"

git() { command git -c user.name=test -c user.email=test@example.org "$@"; }
header() {  # SOURCE: asks for the commit of it
  cmake -DSOURCE="$1" -DHEADER="$work/commit.h" -P "$source/toolchains/cmake/zonepack_commit.cmake"
}
expect_commit() {  # WHEN COMMIT
  grep -qxF "#define ZONEPACK_COMMIT \"$2\"" "$work/commit.h" ||
    { echo "$1: expected commit $2, got"; cat "$work/commit.h"; exit 1; }
}
mkdir -p "$work/repository/unpacked" "$work/plain"
header "$work/plain"
expect_commit "outside a checkout" unknown

git -C "$work/repository" init -q
echo one >"$work/repository/file"
git -C "$work/repository" add file
git -C "$work/repository" commit -qm one
commit=$(git -C "$work/repository" rev-parse HEAD)
header "$work/repository"
expect_commit "a clean checkout" "${commit:0:12}"
touch -d '2001-01-01' "$work/commit.h"
header "$work/repository"
[ "$(date -r "$work/commit.h" +%Y)" = 2001 ] || { echo "the header is written again without a change"; exit 1; }
echo untracked >"$work/repository/other"
header "$work/repository"
expect_commit "a file that is not tracked" "${commit:0:12}"
header "$work/repository/unpacked"
expect_commit "sources inside of another checkout" unknown
echo two >"$work/repository/file"
header "$work/repository"
expect_commit "a changed file" "${commit:0:12}-dirty"
