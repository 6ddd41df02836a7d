#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# usage: loading.sh BIN SOURCE DB ROUNDS: how fast zones are loaded, beside the same work written plainly, LZ4 alone,
# memcpy and `lz4 -b`; how long a cold zone takes from the decision to its first usable signature, beside dd; and how
# long zoned takes to start. Judged: loading decodes at least 0.8 times as fast as the plain copy + XXH3 + LZ4, and what
# zone_latency and start_time judge; their targets, which need a machine that does nothing else, are told.
set -euo pipefail
bin=$1 source=$2 db=$3 rounds=$4
work=$(mktemp -d "${TMPDIR:-/var/tmp}/zonepack-XXXXXX")  # on a disk: what lies in memory is never cold
trap 'rm -rf "$work"' EXIT
fail() { echo "loading: $*" >&2; exit 1; }

"$bin/zonepack" build --db "$db" --zones "$source/tests/data/zones.geojson" --out "$work/map" \
  --payload features,scan,grid >/dev/null 2>&1
"$bin/decode_bench" "$work/map" "$rounds" "$work/decoded" | tee "$work/decode.txt"
echo "lz4 -b9, blocks of 64 KiB, of the same bytes (in one file; level, size, ratio, compress, decompress):"
lz4 -b9 -i1 -B4 "$work/decoded" 2>&1 | tr '\r' '\n' | grep '/s' | tail -1
awk '$1 == "default" { seen = 1; good = $7 >= 0.8 } END { exit !(seen && good) }' "$work/decode.txt" ||
  fail "loading is slower than 0.8 of the plain copy + XXH3 + LZ4"

# On one processor: dd and the loader would else differ by which of them gets the disk's interrupts on its own.
taskset -c 0 "$bin/zone_latency" "$work/map" $((rounds / 10 + 1)) || fail "a cold zone takes too long"

privilege=()
chrt -f 1 true 2>/dev/null || privilege=(--allow-degraded)
export ZONED_SOCKET=$work/zoned.sock
"$bin/start_time" $((rounds / 20 + 5)) "$ZONED_SOCKET" "$bin/zoned" run --config "$source/config/agilex.yaml" \
  --map "$work/map" --can "log:$source/tests/data/scenario1_loop/can0.log" --start 0.9,11,-149 "${privilege[@]}" \
  2>"$work/start.txt" || fail "zoned starts too slowly: $(tail -3 "$work/start.txt")"
