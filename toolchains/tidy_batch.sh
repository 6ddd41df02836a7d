#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: tidy_batch.sh SOURCE: clang-tidy on one source of build/clang, unless it passed before as it is.
set -euo pipefail
command=$(jq -r --arg file "$1" '.[] | select(.file == $file) | .command' build/clang/compile_commands.json)
command=${command#*ccache }
# -C: a comment can be a NOLINT.
preprocess="${command% -o *} -E -C $1"
record=build/clang/tidy/$({ (cd build/clang && eval "$preprocess"); echo "$command"; cat .clang-tidy; } | sha256sum | cut -c1-32)
[ ! -e "$record" ] || exit 0
clang-tidy --quiet -p build/clang "$1" >"$record.log" 2>&1 || { cat "$record.log"; exit 1; }
mv "$record.log" "$record"
