#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: packages_listed_test.sh SOURCE: README names exactly the packages that are installed.
set -euo pipefail
cd "$1"
for list in packages packages-prove packages-cross; do
  diff <(grep -v '^#' toolchains/$list.txt | sort) \
    <(sed -n "/^<!-- $list -->\$/,/^<!-- end -->\$/p" README.md | grep -oE '`[a-z0-9.+-]+`' | tr -d '`' | sort) ||
    { echo "README.md and toolchains/$list.txt list different packages"; exit 1; }
done
