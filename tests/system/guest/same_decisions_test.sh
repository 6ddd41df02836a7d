# SPDX-License-Identifier: Apache-2.0
# boot: virtual-time disk
# The sample run replayed here gives the same event file as on the host, byte for byte.
# shellcheck source=tests/system/guest/lib.sh
. /payload/tests/lib.sh
replay_sample --events events.jsonl --json summary.json
cmp events.jsonl /payload/events.jsonl || fail "the events differ from the host's"
echo "$(wc -l <events.jsonl) events, $(sed -n 's/.*"event_log_hash": *"\([0-9a-f]*\)".*/\1/p' summary.json)"
