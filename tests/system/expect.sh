# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# What a test expects of a command, whose output is left in out.txt, and of a JSON file; sourced.
fail() { echo "$*" >&2; exit 1; }
exits() {  # CODE COMMAND...
  local want=$1 got=0
  shift
  "$@" >out.txt 2>&1 || got=$?
  ((got == want)) || fail "$*: exit code $got, not $want: $(cat out.txt)"
}
says() { grep -q -- "$1" out.txt || fail "no word of '$1' in: $(cat out.txt)"; }
holds() {  # FILE JQ-CONDITION
  jq -e "$2" "$1" >/dev/null || fail "$1 does not hold $2: $(cat "$1")"
}
