#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: packages_listed_test.sh SOURCE: the documents name exactly the packages that are installed.
set -euo pipefail
cd "$1"
listed() {  # LIST DOCUMENT
  diff <(grep -v '^#' "toolchains/$1.txt" | sort) \
    <(sed -n "/^<!-- $1 -->\$/,/^<!-- end -->\$/p" "$2" | grep -oE '`[a-z0-9.+-]+`' | tr -d '`' | sort) ||
    { echo "$2 and toolchains/$1.txt list different packages"; exit 1; }
}
listed packages toolchains/README.md
listed packages-test toolchains/README.md
listed packages-cross toolchains/README.md
listed packages-deb toolchains/README.md
listed packages-prove tests/README.md
