// SPDX-License-Identifier: Apache-2.0
// check_chunk(), which is written for speed, against FlatBuffers' verifier and the rules of
// FORMAT.md written one by one: the same verdict on real chunks and on changed copies of them.
#include <gtest/gtest.h>

#include <cstring>

#include "packer/encode/core_chunk_builder.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/limits.hpp"
#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/reference_checks.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/signature_recipe.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

struct Chunk {
  fb::PayloadKind kind;
  std::uint32_t first, last;
  Bytes bytes;
};

// A chunk where the loader has it: at a multiple of 64, with foreign bytes after it.
class Judge {
 public:
  // Whether check_chunk() accepts; fails the test where the reference says otherwise.
  bool operator()(const Chunk& like, const Bytes& bytes) {
    if (bytes.empty() || bytes.size() > kSlotBytes) return false;
    std::memset(slot_, 0xA5, sizeof slot_);
    std::memcpy(slot_, bytes.data(), bytes.size());
    const ByteSpan chunk{slot_, bytes.size()};
    const Digest16 digest{};
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const fb::ChunkEntry entry(0, 0, flatbuffers::make_span(digest), size, size, like.first,
                               like.last, 0, 0, 0, 0, like.kind, fb::ChunkCodec::Raw, 0, 0);
    const bool accepted = check_chunk(chunk, entry).ok();
    EXPECT_EQ(accepted, reference_accepts(chunk, entry));
    ++(accepted ? accepted_ : refused_);
    return accepted;
  }
  std::size_t accepted() const { return accepted_; }
  std::size_t refused() const { return refused_; }

 private:
  alignas(64) std::byte slot_[kSlotBytes + 64];
  std::size_t accepted_ = 0, refused_ = 0;
};

// Core chunks with many vtables: signatures with and without each field, one continued twice.
std::vector<Chunk> core_chunks() {
  std::vector<Chunk> chunks;
  for (const std::uint32_t count : {1u, 2u, 9u}) {
    std::vector<packer::CoreRecord> records;
    for (std::uint32_t i = 0; i < count; ++i) {
      test_support::SignatureRecipe recipe;
      recipe.id = static_cast<std::int32_t>(i + 1);
      recipe.sensors = i % 2 == 1;
      recipe.label = i % 3 == 1 ? "shelf" : "";
      if (i % 4 == 3) recipe.camera = test_support::SignatureRecipe::Camera::kNone;
      recipe.neighbours.assign(i == 1 ? 70 : i % 5, 1);
      packer::SignatureRecord record = test_support::make_signature(recipe);
      record.weight = i % 3 == 2 ? -1 : 0;
      if (i % 4 == 2) record.pose.reset();
      if (i % 5 == 4) record.stamp = 0;
      for (packer::CoreRecord& part : packer::core_records(record, 7 + i)) {
        records.push_back(std::move(part));
      }
    }
    chunks.push_back({fb::PayloadKind::Core, 7, 6 + count, packer::build_core_chunk(records)});
  }
  return chunks;
}

// The chunks of small maps: seeds hold their kind and signatures first.
std::vector<Chunk> map_chunks(bool core) {
  std::vector<Chunk> chunks;
  for (const Bytes& seed : seeds().chunks) {
    Chunk chunk;
    std::memcpy(&chunk.kind, &seed[0], 1);
    std::memcpy(&chunk.first, &seed[1], 4);
    std::memcpy(&chunk.last, &seed[5], 4);
    chunk.bytes.assign(seed.begin() + 9, seed.end());
    if ((chunk.kind == fb::PayloadKind::Core) == core) chunks.push_back(std::move(chunk));
  }
  return chunks;
}

void mutate(const std::vector<Chunk>& chunks, std::size_t rounds) {
  Judge judge;
  for (const Chunk& chunk : chunks) EXPECT_TRUE(judge(chunk, chunk.bytes));
  Mutator mutator(41);
  for (std::size_t i = 0; i < rounds && !testing::Test::HasFailure(); ++i) {
    const Chunk& chunk = chunks[i % chunks.size()];
    judge(chunk, mutator(chunk.bytes));
  }
  EXPECT_GT(judge.accepted(), rounds / 10);
  EXPECT_GT(judge.refused(), rounds / 10);
}

TEST(ChunkCheck, JudgesChangedCoreChunksAsTheVerifierDoes) { mutate(core_chunks(), 400000); }

TEST(ChunkCheck, JudgesChangedCoreChunksOfMapsAsTheVerifierDoes) {
  mutate(map_chunks(true), 150000);
}

TEST(ChunkCheck, JudgesChangedBulkChunksAsTheVerifierDoes) { mutate(map_chunks(false), 300000); }

TEST(ChunkCheck, JudgesEveryFlippedBitOfACoreChunkAsTheVerifierDoes) {
  Judge judge;
  for (const Chunk& chunk : core_chunks()) {
    Bytes bytes = chunk.bytes;
    for (std::size_t bit = 0; bit < bytes.size() * 8 && !HasFailure(); ++bit) {
      const auto mask = static_cast<std::byte>(1u << (bit % 8));
      bytes[bit / 8] ^= mask;
      judge(chunk, bytes);
      bytes[bit / 8] ^= mask;
    }
  }
  EXPECT_GT(judge.accepted(), 10000u);  // numbers that may be anything
  EXPECT_GT(judge.refused(), 1000u);
}

TEST(ChunkCheck, JudgesEveryLengthOfACoreChunkAsTheVerifierDoes) {
  Judge judge;
  for (const Chunk& chunk : core_chunks()) {
    for (Bytes bytes = chunk.bytes; !bytes.empty() && !HasFailure(); bytes.pop_back()) {
      judge(chunk, bytes);
    }
  }
  EXPECT_GT(judge.refused(), 1000u);
}

// Every 16-bit place holds numbers of vtables: fields that lie elsewhere, past the end, or across
// it.
TEST(ChunkCheck, JudgesEveryMovedFieldOfACoreChunkAsTheVerifierDoes) {
  static constexpr std::uint16_t kPlaces[] = {0,  1,  2,  4,  5,   6,      8,
                                              12, 30, 32, 34, 100, 0x3FFC, 0xFFFE};
  Judge judge;
  for (const Chunk& chunk : core_chunks()) {
    const std::size_t end = std::min<std::size_t>(chunk.bytes.size(), 3000);
    for (std::size_t at = 0; at + 2 <= end && !HasFailure(); at += 2) {
      Bytes bytes = chunk.bytes;
      for (const std::uint16_t value : kPlaces) {
        std::memcpy(&bytes[at], &value, 2);
        judge(chunk, bytes);
      }
    }
  }
  EXPECT_GT(judge.refused(), 1000u);
}

// The chunk with its second signature replaced by a copy of the first's table after the chunk,
// `padding` bytes after a multiple of 8; both use one vtable.
Bytes with_twin(Bytes bytes, std::size_t padding) {
  const fb::CoreChunk& chunk = *fb::GetCoreChunk(bytes.data());
  const auto place_of = [&](const void* p) {
    return static_cast<std::size_t>(static_cast<const std::byte*>(p) - bytes.data());
  };
  const std::size_t entry = place_of(chunk.signatures()->Data()) + 4;
  const std::size_t from = place_of(chunk.signatures()->Get(0));
  std::int32_t to_vtable;
  std::memcpy(&to_vtable, &bytes[from], 4);
  std::uint16_t table_bytes;
  std::memcpy(&table_bytes, &bytes[from - static_cast<std::size_t>(to_vtable) + 2], 2);

  const std::size_t to = (bytes.size() + 7) / 8 * 8 + padding;
  bytes.resize(to + table_bytes);
  std::memcpy(&bytes[to], &bytes[from], table_bytes);
  to_vtable += static_cast<std::int32_t>(to - from);
  std::memcpy(&bytes[to], &to_vtable, 4);
  const auto offset = static_cast<std::uint32_t>(to - entry);
  std::memcpy(&bytes[entry], &offset, 4);
  return bytes;
}

TEST(ChunkCheck, ChecksEveryTableOfAVtableThatItKnows) {
  std::vector<packer::CoreRecord> records(2);
  for (packer::CoreRecord& core : records) {
    core.record.id = 1;
    core.record.stamp = 1.5;  // 8 bytes, which must be aligned
    core.record.pose = test_support::level_pose(1, 2);
  }
  const Chunk chunk{fb::PayloadKind::Core, 0, 1, packer::build_core_chunk(records)};
  const fb::Signature& first = *fb::GetCoreChunk(chunk.bytes.data())->signatures()->Get(0);
  const bool begins_at_8 =
      (reinterpret_cast<const std::byte*>(&first) - chunk.bytes.data()) % 8 == 0;
  const std::size_t aligned = begins_at_8 ? 0 : 4;  // the stamp lies where that makes it a multiple
  Judge judge;
  for (std::size_t padding = 0; padding < 16; ++padding) {
    Bytes bytes = with_twin(chunk.bytes, padding);
    EXPECT_EQ(judge(chunk, bytes), padding % 8 == aligned) << padding;
    bytes.resize(bytes.size() - 8);  // the end of its last fields
    EXPECT_FALSE(judge(chunk, bytes)) << padding;
  }
}

}  // namespace
}  // namespace zonepack::fuzz
