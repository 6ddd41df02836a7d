// SPDX-License-Identifier: Apache-2.0
// The robot's loader under every damage of a small pack: an error, or the bytes that were packed.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>

#include "runtime/map/loader.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

struct alignas(64) Slot {
  std::byte bytes[kSlotBytes];
};

class LoaderDamage : public testing::TestWithParam<PayloadMask> {
 protected:
  LoaderDamage() : buffer_(kReadBufferBytes) {
    for (const auto& [name, bytes] : map_.folder.files) {
      test_support::write_bytes(disk_ / name, bytes);
    }
    catalog_ = *Catalog::open(disk_.path().string(), GetParam());
    for (std::uint32_t i = 0; i < catalog_.zones[0].slots; ++i) {
      memory_.push_back(std::make_unique<Slot>());
      slots_.push_back(memory_.back()->bytes);
    }
    file_ = ::open((disk_ / catalog_.zones[0].pack).c_str(), O_RDWR | O_CLOEXEC);
    whole_ = *load();
  }
  ~LoaderDamage() override { ::close(file_); }

  // The decoded chunks of zone a, one after the other; nothing when the loader refused.
  std::optional<Bytes> load() {
    // Through the cache: other ways would wait for the disk at each of many thousand changes.
    auto load = ZoneLoad::begin(catalog_, 0, slots_, buffer_, ReadMode::kCached);
    if (!load) return std::nullopt;
    for (;;) {
      const Result<bool> more = load->step();
      if (!more) return std::nullopt;
      if (!*more) break;
    }
    Bytes decoded;
    for (const ChunkRef& chunk : load->chunks()) {
      decoded.insert(decoded.end(), chunk.bytes.begin(), chunk.bytes.end());
    }
    return decoded;
  }

  void write_at(std::size_t offset, std::byte value) {
    ASSERT_EQ(::pwrite(file_, &value, 1, static_cast<off_t>(offset)), 1);
  }

  test_support::SmallMap map_;
  test_support::TemporaryFolder disk_;
  Catalog catalog_;
  std::vector<std::unique_ptr<Slot>> memory_;
  std::vector<std::byte*> slots_;
  std::vector<std::byte> buffer_;
  int file_ = -1;
  Bytes whole_;
};

TEST_P(LoaderDamage, AnyFlippedBitIsRefusedOrNotUsed) {
  const Bytes pack = map_.folder.files[map_.packs[0].file];
  ASSERT_FALSE(whole_.empty());
  std::size_t refused = 0, same = 0;
  for (std::size_t bit = 0; bit < pack.size() * 8; ++bit) {
    write_at(bit / 8, pack[bit / 8] ^ static_cast<std::byte>(1u << (bit % 8)));
    const std::optional<Bytes> decoded = load();
    write_at(bit / 8, pack[bit / 8]);
    refused += !decoded;
    same += decoded && *decoded == whole_;
  }
  EXPECT_EQ(refused + same, pack.size() * 8);
  // Only the stored bytes of other kinds are unused.
  std::size_t unused = 0;
  const PackReader reader = PackReader::open((disk_ / map_.packs[0].file).string()).value();
  const PayloadMask used = payload_closure(GetParam(), reader.index().grid_needs_scan());
  for (const fb::ChunkEntry* entry : *reader.index().chunks()) {
    if ((used & mask_of(entry->kind())) == 0) unused += entry->stored_size();
  }
  EXPECT_EQ(same, unused * 8);
}

TEST_P(LoaderDamage, AnyTruncationIsRefused) {
  for (std::size_t size = map_.packs[0].bytes; size-- > 0;) {
    ASSERT_EQ(::ftruncate(file_, static_cast<off_t>(size)), 0);
    ASSERT_FALSE(load()) << size << " bytes";
  }
}

TEST_P(LoaderDamage, AWholePackOfAnotherMapUnderTheRightNameIsRefused) {
  test_support::SignatureRecipe other;
  other.x = 2;
  other.y = 2;
  const test_support::SmallMap stranger({other}, {});
  test_support::write_bytes(disk_ / map_.packs[0].file,
                            stranger.folder.files.at(stranger.packs[0].file));
  EXPECT_FALSE(load());
}

INSTANTIATE_TEST_SUITE_P(Payloads, LoaderDamage,
                         testing::Values(kCoreOnly, kDefaultPayload, kEveryPayload));

}  // namespace
}  // namespace zonepack::packer
