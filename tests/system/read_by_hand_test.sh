#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Reads the golden map as FORMAT.md tells, with od, b2sum, lz4 and flatc, and with nothing of Zonepack:
# what others can read with common tools is what the document says.
# usage: read_by_hand_test.sh SOURCE_DIR
set -euo pipefail
golden=$1/tests/golden schemas=$1/runtime/pack_format
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "FAILED: $*" >&2; exit 1; }
equal() { [[ $2 == "$3" ]] || fail "$1: $2, expected $3"; }
# Bytes [offset, offset + size) of a file.
cut_out() { dd if="$1" bs=64K iflag=skip_bytes,count_bytes skip="$2" count="$3" status=none; }
# An unsigned number of 1, 2, 4 or 8 bytes at an offset.
number() { od -An -v -t u"$3" -j "$2" -N "$3" "$1" | tr -d ' '; }
hex() { od -An -v -t x1 | tr -d ' \n'; }
# A FlatBuffer as JSON: schema, root type, file.
to_json() {
  flatc --json --strict-json --raw-binary --defaults-json --root-type "zonepack.fb.$2" \
    -o "$work" "$schemas/$1" -- "$3"
  cat "${3%.bin}.json"
}
# Adds the frame around an LZ4 block that the lz4 program wants: blocks of up to 64 KiB, no checksums.
unlz4() {
  { printf '\x04\x22\x4d\x18\x60\x40\x82'
    # shellcheck disable=SC2059  # the inner printf writes the escapes that the outer one prints as bytes
    printf "$(printf '\\x%02x\\x%02x\\x%02x\\x%02x' $(($2 & 255)) $(($2 >> 8 & 255)) 0 0)"
    cat "$1"
    printf '\0\0\0\0'; } | lz4 -d -c -q
}

# ---- the manifest ----
manifest=$golden/map/manifest.zpm
length=$(stat -c %s "$manifest")
equal 'magic of the manifest' "$(head -c 8 "$manifest" | hex)" 895a504d0d0a1a0a
equal 'its end' "$(tail -c 8 "$manifest" | hex)" 0a1a0a0d4d505a89
equal 'its version' "$(number "$manifest" 8 2).$(number "$manifest" 10 2)" 1.0
size=$(number "$manifest" 12 4)
equal 'its length' "$length" $((16 + size + 40))
equal 'its digest' "$(cut_out "$manifest" $((16 + size)) 32 | hex)" \
  "$(head -c $((16 + size)) "$manifest" | b2sum -l 256 | cut -d' ' -f1)"
cut_out "$manifest" 16 "$size" >"$work/manifest.bin"
to_json manifest.fbs Manifest "$work/manifest.bin" >/dev/null
equal 'zones' "$(jq -r '[.zones[].name] | join(" ")' "$work/manifest.json")" 'hall lab store'
equal 'nodes of hall' "$(jq -c '[.zones[0].nodes[].id]' "$work/manifest.json")" '[1,2,3,4]'
equal 'portal' "$(jq -c '.portals[0] | [.name, .zone_a, .zone_b, .p.x == 2, .q.x == 3]' "$work/manifest.json")" \
  '["hall-lab",0,1,true,true]'

# ---- its packs ----
chunks=0 blocks=0
for zone in 0 1 2; do
  pack=$golden/map/$(jq -r ".zones[$zone].pack" "$work/manifest.json")
  length=$(stat -c %s "$pack")
  equal 'length of the pack' "$length" "$(jq ".zones[$zone].pack_bytes" "$work/manifest.json")"
  equal 'magic of the pack' "$(head -c 8 "$pack" | hex)" 895a504b0d0a1a0a
  equal 'its end' "$(tail -c 8 "$pack" | hex)" 0a1a0a0d4b505a89
  tail=$((length - 64))
  index_offset=$(number "$pack" "$tail" 8)
  index_size=$(number "$pack" $((tail + 8)) 8)
  equal 'end of the index' $((index_offset + index_size)) "$tail"
  digest=$({ head -c 16 "$pack"; cut_out "$pack" "$index_offset" "$index_size"; cut_out "$pack" "$tail" 24; } |
    b2sum -l 256 | cut -d' ' -f1)
  equal 'digest of the pack' "$(cut_out "$pack" $((tail + 24)) 32 | hex)" "$digest"
  equal 'digest in its name' "$(basename "$pack" .zpk | sed 's/.*-//')" "${digest:0:16}"
  equal 'digest in the manifest' \
    "$(jq -r ".zones[$zone].pack_digest[]" "$work/manifest.json" | xargs printf %02x)" "$digest"
  cut_out "$pack" "$index_offset" "$index_size" >"$work/index.bin"
  to_json pack.fbs PackIndex "$work/index.bin" >/dev/null
  cp "$work/index.json" "$work/index-$zone.json"
  for ((i = 0; i < $(jq '.chunks | length' "$work/index.json"); ++i)); do
    entry() { jq -r ".chunks[$i].$1" "$work/index.json"; }
    cut_out "$pack" "$(entry offset)" "$(entry stored_size)" >"$work/stored"
    equal "BLAKE2b-16 of chunk $i" "$(b2sum -l 128 "$work/stored" | cut -d' ' -f1)" \
      "$(jq -r ".chunks[$i].digest[]" "$work/index.json" | xargs printf %02x)"
    chunk=$work/chunk-$zone-$i.bin
    if [[ $(entry codec) == Raw ]]; then
      cp "$work/stored" "$chunk"
    else
      unlz4 "$work/stored" "$(entry stored_size)" >"$chunk"
      blocks=$((blocks + 1))
    fi
    equal "decoded length of chunk $i" "$(stat -c %s "$chunk")" "$(entry decoded_size)"
    if [[ $(entry kind) == Core ]]; then
      to_json core_chunk.fbs CoreChunk "$chunk" >/dev/null
    else
      to_json bulk_chunk.fbs BulkChunk "$chunk" >/dev/null
    fi
    chunks=$((chunks + 1))
  done
done
((blocks >= 2)) || fail "only $blocks of $chunks chunks were LZ4 blocks"

# ---- what the chunks hold, against the text beside the map ----
# shellcheck disable=SC2046  # a file each chunk
ids=$(jq -s -c '[.[].signatures[] | select(.continued | not) | .id]' \
  $(jq -r '.chunks | to_entries[] | select(.value.kind == "Core") | .key' "$work/index-0.json" |
    sed "s|.*|$work/chunk-0-&.json|"))
equal 'ids of hall' "$ids" '[1,2,3,4]'
core=$work/chunk-0-$(jq -r '[.chunks | to_entries[] | select(.value.kind == "Core") | .key][0]' "$work/index-0.json").json
equal 'label of 1' "$(jq -r '.signatures[0].label' "$core")" "$(head -1 "$golden/hall.jsonl" | jq -r .label)"
equal 'stamp of 1' "$(jq '.signatures[0].stamp * 1' "$core")" "$(head -1 "$golden/hall.jsonl" | jq '.stamp * 1')"
equal 'pose of 1' "$(jq -c '[.signatures[0].pose.m[] * 1]' "$core")" \
  "$(head -1 "$golden/hall.jsonl" | jq -c '[.pose[] * 1]')"

# The word ids of signature 1 are a Blocks column; the header of its second block begins with the
# least of rows 32 to 63, which is the first, as they ascend.
features=$work/chunk-0-$(jq -r '[.chunks | to_entries[] | select(.value.kind == "Features") | .key][0]' "$work/index-0.json")
column=$(jq -c '[.columns[] | select(.field == "WordId")][0]' "$features.json")
equal 'codec of its words' "$(jq -r .codec <<<"$column")" Blocks
jq -r '.bytes[]' "$features.json" | awk -v at="$(jq .offset <<<"$column")" 'NR > at + 8 && NR <= at + 16' >"$work/head"
mapfile -t b <"$work/head"
base=$(((b[0] | b[1] << 8 | b[2] << 16 | b[3] << 24) ^ 0x80000000))
equal 'word id of row 32' "$base" "$(head -1 "$golden/hall.jsonl" | jq '.features.word_id[32]')"
echo "read $chunks chunks of 3 packs by hand, $blocks of them LZ4 blocks"
