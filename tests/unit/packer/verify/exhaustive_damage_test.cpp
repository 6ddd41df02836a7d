// SPDX-License-Identifier: Apache-2.0
// Every possible single damage of a small map.
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "packer/verify/map_verifier.hpp"
#include "packer/verify/pack_verifier.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "tests/support/small_map.hpp"

namespace zonepack::packer {
namespace {

using test_support::SmallMap;

std::string list(const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + "\n";
  return text;
}

Problems problems_of(const SmallMap& map, const std::string& file) {
  Problems problems;
  verify_pack(**map.folder.open(file), file, problems);
  return problems;
}

// The index of a whole pack.
class IndexOf {
 public:
  explicit IndexOf(const Bytes& pack) {
    const PackTail tail = *check_tail(ByteSpan(pack).last(sizeof(PackTail)), pack.size());
    words_.resize((tail.index_size + 7) / 8);
    std::memcpy(words_.data(), pack.data() + tail.index_offset, tail.index_size);
    index_ = *check_index(ByteSpan(pack).first(sizeof(PackHeader)),
                          std::as_bytes(std::span(words_)).first(tail.index_size), tail);
  }
  const fb::PackIndex* operator->() const { return index_; }

 private:
  std::vector<std::uint64_t> words_;
  const fb::PackIndex* index_ = nullptr;
};

// Calls check() with every bit flipped in turn.
template <typename Check>
void flip_every_bit(Bytes& bytes, Check&& check) {
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    const auto mask = static_cast<std::byte>(1u << (bit % 8));
    bytes[bit / 8] ^= mask;
    check(bit);
    bytes[bit / 8] ^= mask;
  }
}

class ExhaustiveDamage : public testing::Test {
 protected:
  SmallMap map_;
  const std::string pack_a_ = map_.packs[0].file;
  Bytes& bytes_ = map_.folder.files[pack_a_];
  Bytes& manifest_ = map_.folder.files[std::string(kManifestName)];
};

TEST_F(ExhaustiveDamage, TheMapIsWholeAndHoldsEveryPayloadRawAndCompressed) {
  const Verdict verdict = verify_map(map_.folder);
  EXPECT_TRUE(verdict.whole()) << list(verdict.problems);
  EXPECT_EQ(verdict.packs, 2u);
  EXPECT_EQ(verdict.signatures, 2u);
  std::set<fb::PayloadKind> kinds;
  std::set<fb::ChunkCodec> codecs;
  const IndexOf index(bytes_);
  for (const fb::ChunkEntry* entry : *index->chunks()) {
    kinds.insert(entry->kind());
    codecs.insert(entry->codec());
  }
  EXPECT_EQ(kinds.size(), kPayloadKinds);
  EXPECT_EQ(codecs.size(), 2u);
}

TEST_F(ExhaustiveDamage, EveryFlippedBitOfAPackIsFound) {
  std::size_t missed = 0;
  flip_every_bit(bytes_, [&](std::size_t) { missed += problems_of(map_, pack_a_).empty(); });
  EXPECT_EQ(missed, 0u);
}

TEST_F(ExhaustiveDamage, EveryFlippedBitOfAChunkIsFoundThere) {
  const PackTail tail = *check_tail(ByteSpan(bytes_).last(sizeof(PackTail)), bytes_.size());
  std::size_t elsewhere = 0;
  for (std::size_t at = sizeof(PackHeader); at < tail.index_offset; ++at) {
    bytes_[at] ^= std::byte{0x10};
    const Problems problems = problems_of(map_, pack_a_);
    bytes_[at] ^= std::byte{0x10};
    const bool there = problems.size() == 1 && problems[0].place.chunk &&
                       problems[0].place.zone == "a" && *problems[0].place.offset <= at &&
                       at < *problems[0].place.offset + kSlotBytes;
    elsewhere += !there;
  }
  EXPECT_EQ(elsewhere, 0u);
}

TEST_F(ExhaustiveDamage, EveryFlippedBitOfTheManifestIsFound) {
  std::size_t missed = 0;
  flip_every_bit(manifest_, [&](std::size_t) { missed += check_manifest(manifest_).ok(); });
  EXPECT_EQ(missed, 0u);
}

TEST_F(ExhaustiveDamage, EveryTruncationOfAPackIsFound) {
  const Bytes whole = bytes_;
  while (!bytes_.empty()) {
    bytes_.pop_back();
    ASSERT_FALSE(problems_of(map_, pack_a_).empty()) << bytes_.size() << " bytes";
  }
  EXPECT_EQ(whole.size(), map_.packs[0].bytes);
}

TEST_F(ExhaustiveDamage, EveryTruncationOfTheManifestIsFound) {
  while (!manifest_.empty()) {
    manifest_.pop_back();
    ASSERT_FALSE(check_manifest(manifest_).ok()) << manifest_.size() << " bytes";
  }
}

TEST_F(ExhaustiveDamage, EveryByteAppendedIsFound) {
  for (int value = 0; value < 256; ++value) {
    bytes_.push_back(static_cast<std::byte>(value));
    manifest_.push_back(static_cast<std::byte>(value));
    ASSERT_FALSE(problems_of(map_, pack_a_).empty()) << value;
    ASSERT_FALSE(check_manifest(manifest_).ok()) << value;
    bytes_.pop_back();
    manifest_.pop_back();
  }
}

// Swaps the stored bytes of two chunks; where they differ in length, the bytes between move.
Bytes with_swapped(const Bytes& pack, std::size_t a, std::size_t a_size, std::size_t b,
                   std::size_t b_size) {
  const auto at = [&](std::size_t i) { return pack.begin() + static_cast<std::ptrdiff_t>(i); };
  Bytes out(at(0), at(a));
  out.insert(out.end(), at(b), at(b + b_size));
  out.insert(out.end(), at(a + a_size), at(b));
  out.insert(out.end(), at(a), at(a + a_size));
  out.insert(out.end(), at(b + b_size), pack.end());
  return out;
}

TEST_F(ExhaustiveDamage, EverySwapOfTwoChunksIsFound) {
  const Bytes whole = bytes_;
  const IndexOf index(whole);
  const auto& chunks = *index->chunks();
  std::size_t swaps = 0;
  for (std::uint32_t i = 0; i < chunks.size(); ++i) {
    for (std::uint32_t k = i + 1; k < chunks.size(); ++k) {
      const fb::ChunkEntry &a = *chunks.Get(i), &b = *chunks.Get(k);
      bytes_ = with_swapped(whole, a.offset(), a.stored_size(), b.offset(), b.stored_size());
      ASSERT_EQ(bytes_.size(), whole.size());
      EXPECT_FALSE(problems_of(map_, pack_a_).empty()) << "chunks " << i << " and " << k;
      ++swaps;
    }
  }
  EXPECT_GE(swaps, 21u);  // 7 kinds, one chunk each at least: 7 x 6 / 2
}

TEST_F(ExhaustiveDamage, PacksUnderTheNamesOfEachOtherAreFound) {
  std::swap(map_.folder.files[map_.packs[0].file], map_.folder.files[map_.packs[1].file]);
  const Verdict verdict = verify_map(map_.folder);
  EXPECT_EQ(verdict.problems.size(), 4u) << list(verdict.problems);  // zone and digest, twice
}

TEST_F(ExhaustiveDamage, ListsEveryProblemNotOnlyTheFirst) {
  bytes_[sizeof(PackHeader)] ^= std::byte{1};                // first chunk of a
  map_.folder.files[map_.packs[1].file][0] ^= std::byte{1};  // header of b
  const Verdict verdict = verify_map(map_.folder);
  ASSERT_EQ(verdict.problems.size(), 2u) << list(verdict.problems);
  EXPECT_EQ(verdict.problems[0].place.zone, "a");
  EXPECT_EQ(verdict.problems[0].place.chunk, 0u);
  EXPECT_EQ(verdict.problems[0].place.offset, sizeof(PackHeader));
  EXPECT_EQ(verdict.problems[1].place.zone, "b");
  EXPECT_EQ(verdict.problems[1].place.offset, 0u);
}

}  // namespace
}  // namespace zonepack::packer
