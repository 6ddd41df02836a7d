// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/seeds.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "runtime/pack_format/file/pack_file.hpp"
#include "tests/support/small_map.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

template <typename T>
void put(Bytes& out, T value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

struct alignas(64) Slot {
  std::byte bytes[kSlotBytes];
};

void add_chunk(Seeds& seeds, const fb::ChunkEntry& entry, ByteSpan stored) {
  static Slot slot;
  const ByteSpan decoded = *decode_chunk(entry, stored, slot.bytes);
  Bytes chunk;
  put(chunk, entry.kind());
  put(chunk, entry.first_signature());
  put(chunk, entry.last_signature());
  chunk.insert(chunk.end(), decoded.begin(), decoded.end());
  seeds.chunks.push_back(std::move(chunk));
  if (entry.codec() != fb::ChunkCodec::Lz4 || entry.last_signature() != 0) return;
  Bytes block;
  put(block, entry.kind());
  put(block, entry.decoded_size() - 1);
  block.insert(block.end(), stored.begin(), stored.end());
  seeds.blocks.push_back(std::move(block));
}

void add_pack(Seeds& seeds, const Bytes& pack) {
  seeds.packs.push_back(pack);
  const PackTail tail = *check_tail(ByteSpan(pack).last(sizeof(PackTail)), pack.size());
  const auto index_size = static_cast<std::size_t>(tail.index_size);
  std::vector<std::uint64_t> words((index_size + 7) / 8);
  const auto index = std::as_writable_bytes(std::span(words)).first(index_size);
  std::memcpy(index.data(), pack.data() + tail.index_offset, index.size());
  seeds.indexes.emplace_back(index.begin(), index.end());
  const auto checked = check_index(ByteSpan(pack).first(sizeof(PackHeader)), index, tail);
  for (const fb::ChunkEntry* entry : *(*checked)->chunks()) {
    add_chunk(
        seeds, *entry,
        ByteSpan(pack).subspan(static_cast<std::size_t>(entry->offset()), entry->stored_size()));
  }
}

// The files of config/, and one with what they do not have.
void add_dbcs(Seeds& seeds) {
  const auto add = [&seeds](std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text));
    seeds.dbcs.emplace_back(bytes.begin(), bytes.end());
  };
  for (const auto& entry : std::filesystem::directory_iterator(ZONEPACK_SOURCE_DIR "/config")) {
    if (entry.path().extension() != ".dbc") continue;
    std::ifstream file(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    add(text.str());
  }
  add("NS_ : CM_ BA_\nBS_: 1:2,3\nBU_: N\nVAL_TABLE_ T 1 \"a;\" ;\nBO_ 2147483749 M: 8 N\n"
      " SG_ A M : 0|8@1+ (1,0) [0|0] \"\" N\n SG_ B m1M : 8|8@1- (0.5,-1e1) [0|9] \"m\" N,O\n"
      " SG_ C m3 : 23|32@0- (1,0) [0|0] \"\" N\nCM_ SG_ 2147483749 A \"x\ny\";\n"
      "BA_DEF_DEF_ \"GenMsgCycleTime\" 10;\nBA_ \"GenMsgCycleTime\" BO_ 2147483749 20;\n"
      "SIG_VALTYPE_ 2147483749 C : 1;\nSG_MUL_VAL_ 2147483749 B A 1-1;\n"
      "SG_MUL_VAL_ 2147483749 C B 3-4, 6-7;\n");
}

Seeds make_seeds() {
  Seeds seeds;
  const auto add = [&](const test_support::SmallMap& map) {
    for (const auto& [name, bytes] : map.folder.files) {
      if (name != kManifestName) {
        add_pack(seeds, bytes);
        continue;
      }
      seeds.manifests.emplace_back(bytes.begin() + sizeof(ManifestHeader),
                                   bytes.end() - sizeof(ManifestTail));
    }
  };
  add(test_support::SmallMap());
  // Several signatures in a pack: tables over several chunks, shared matrices, all other payloads.
  std::vector<test_support::SignatureRecipe> many(6);
  for (std::size_t i = 0; i < many.size(); ++i) {
    test_support::SignatureRecipe& recipe = many[i];
    recipe.id = static_cast<std::int32_t>(i + 1);
    recipe.x = 1 + static_cast<float>(i) / 4;
    recipe.y = 2;
    recipe.features = 150;
    recipe.scan_format = static_cast<std::int32_t>(i % 2 == 0 ? 1 : 2 + i);
    recipe.grid_channels = i == 3 ? 3 : 2;
    recipe.descriptor =
        i == 4 ? packer::Features::DescriptorType::kF32 : packer::Features::DescriptorType::kU8;
    recipe.global_descriptor = recipe.user_data = recipe.sensors = true;
    recipe.neighbours = {recipe.id % 6 + 1};
    recipe.label = "shelf";
  }
  add(test_support::SmallMap(many, {}));
  add_dbcs(seeds);
  return seeds;
}

}  // namespace

const Seeds& seeds() {
  static const Seeds all = make_seeds();
  return all;
}

}  // namespace zonepack::fuzz
