#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: packages_listed_test.sh SOURCE: README names exactly the packages that are installed.
set -euo pipefail
cd "$1"
diff <(grep -v '^#' toolchains/packages.txt | sort) \
  <(sed -n '/^<!-- packages -->$/,/^<!-- end -->$/p' README.md | grep -oE '`[a-z0-9.+-]+`' | tr -d '`' | sort) ||
  { echo "README.md and toolchains/packages.txt list different packages"; exit 1; }
