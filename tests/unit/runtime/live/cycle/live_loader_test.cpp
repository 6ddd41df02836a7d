// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/live_loader.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "platform/process/clock.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack {
namespace {

const std::string kMap = std::string(ZONEPACK_SOURCE_DIR) + "/tests/golden/map";

class Loading : public testing::Test {
 protected:
  Loading() {
    catalog = Catalog::open(kMap, kDefaultPayload).value();
    slots = catalog.zones[0].slots + catalog.zones[1].slots;
    bytes = shared_map_bytes(2, slots);
    block.reset(static_cast<std::byte*>(std::aligned_alloc(4096, bytes)));
    std::memset(block.get(), 0, bytes);
    map = std::make_unique<SharedMap>(SharedMap::lay_out({block.get(), bytes}, 2, slots).value());
    loader = std::make_unique<LiveLoader>(catalog, *map);
    EXPECT_TRUE(loader->start({.name = "loader"}, true).ok());
  }

  LoadResult result() {
    for (;;) {
      if (const auto done = loader->poll()) return *done;
      sleep_until_ns(monotonic_ns() + 100'000);
    }
  }

  LoadResult load(ZoneId zone, std::uint32_t generation) {
    loader->load({zone, generation, catalog.zones[zone].slots});
    return result();
  }

  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  Catalog catalog;
  std::uint32_t slots = 0;
  std::size_t bytes = 0;
  std::unique_ptr<std::byte, Free> block;
  std::unique_ptr<SharedMap> map;
  std::unique_ptr<LiveLoader> loader;
};

TEST_F(Loading, PutsAZoneIntoSlotsAndTellsWhereItsChunksStand) {
  const LoadResult done = load(0, 3);
  ASSERT_EQ(done.error.code, ErrorCode::kOk);
  EXPECT_EQ(done.generation, 3u);
  EXPECT_EQ(done.slots.count, catalog.zones[0].slots);
  std::vector<ChunkRef> chunks;
  for (SlotIndex slot = done.slots.head; slot != kNoSlot; slot = map->links()[slot]) {
    for (const SharedChunk& chunk : map->chunks(slot)) {
      if (chunk.bytes == 0) break;
      chunks.push_back(
          {static_cast<fb::PayloadKind>(chunk.kind),
           ByteSpan(map->slot(slot)).subspan(chunk.offset_lines * kChunkAlignment, chunk.bytes)});
    }
  }
  const auto view = ZoneView::make(chunks);
  ASSERT_TRUE(view.ok());
  EXPECT_EQ(view->size(), catalog.zones[0].signatures);
  EXPECT_EQ(loader->bytes_loaded(), catalog.zones[0].stored_bytes);
}

TEST_F(Loading, UsesSlotsAgainThatWereGivenBack) {
  for (std::uint32_t turn = 1; turn <= 20; ++turn) {
    const LoadResult a = load(0, turn), b = load(1, turn);
    ASSERT_EQ(a.error.code, ErrorCode::kOk);
    ASSERT_EQ(b.error.code, ErrorCode::kOk);
    loader->take_back(a.slots);
    loader->take_back(b.slots);
  }
}

TEST_F(Loading, AnswersACancelledLoadOnceWithItsSlotsGivenBack) {
  for (std::uint32_t turn = 1; turn <= 20; ++turn) {
    loader->load({0, turn, catalog.zones[0].slots});
    loader->cancel();
    const LoadResult done = result();
    if (done.error.code == ErrorCode::kOk) {
      loader->take_back(done.slots);
    } else {
      EXPECT_EQ(done.error.code, ErrorCode::kCancelled);
      EXPECT_EQ(done.slots.count, 0u);
    }
    EXPECT_FALSE(loader->poll());
  }
  EXPECT_EQ(load(1, 1).error.code, ErrorCode::kOk);
}

TEST_F(Loading, KeepsToItsRateAndGivesUpInTheMiddleOfAPause) {
  // At 1 byte a second the bucket of 64 KiB serves two loads of this zone; a third would take
  // hours.
  loader = std::make_unique<LiveLoader>(catalog, *map, ReadingChoice{.rate_limit = 1});
  EXPECT_TRUE(loader->start({.name = "loader"}, true).ok());
  const ByteCount bytes_of_load = catalog.zones[0].stored_bytes + sizeof(PackHeader) +
                                  open_pack(catalog, 0)->tail().index_size + sizeof(PackTail);
  ASSERT_LE(2 * bytes_of_load, kReadBufferBytes);
  ASSERT_GT(3 * bytes_of_load, kReadBufferBytes);
  for (std::uint32_t turn = 1; turn <= 2; ++turn) {
    const LoadResult done = load(0, turn);
    ASSERT_EQ(done.error.code, ErrorCode::kOk);
    loader->take_back(done.slots);
  }
  loader->load({0, 3, catalog.zones[0].slots});
  sleep_until_ns(monotonic_ns() + 5'000'000);  // without a limit it would be done by now
  loader->cancel();
  EXPECT_EQ(result().error.code, ErrorCode::kCancelled);
  loader->load({0, 4, catalog.zones[0].slots});
  loader->stop();  // and comes back
}

TEST_F(Loading, FailsAZoneWhosePackIsNotThereAndGoesOnWithOthers) {
  catalog.zones[0].pack = "nowhere.zpk";
  EXPECT_EQ(load(0, 1).error.code, ErrorCode::kNotFound);
  EXPECT_EQ(load(1, 1).error.code, ErrorCode::kOk);
}

}  // namespace
}  // namespace zonepack
