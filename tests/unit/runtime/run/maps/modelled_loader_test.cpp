// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/maps/modelled_loader.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace zonepack {
namespace {

class BrokenZoneOne final : public ZoneFiller {
 public:
  Result<void> fill(ZoneId zone, std::span<const SlotIndex> slots) override {
    filled.emplace_back(slots.begin(), slots.end());
    if (zone == 1) return {ErrorCode::kBadChecksum, 42};
    return {};
  }
  std::vector<std::vector<SlotIndex>> filled;
};

// 1000 stored bytes at 1000 bytes/s and 500 decoded at 5000: 1.1 s; 11 slots, so 0.1 s a chunk.
const std::vector<LoadWork> kWork(2, LoadWork{1000, 500});
constexpr LoadRates kRates{1000, 5000};

TEST(LoadTime, AddsReadingAndDecoding) {
  EXPECT_EQ(load_time_ns({1000, 500}, kRates), 1'100'000'000);
  EXPECT_EQ(load_time_ns({1, 0}, {3, 1}), 333'333'333);  // rounded down
  EXPECT_EQ(load_time_ns({0, 0}, kRates), 0);
}

TEST(LoadTime, DoesNotOverflowForHugeZonesOrRates) {
  // 10^13 bytes at 10^12 bytes/s and at 1000 bytes/s.
  EXPECT_EQ(load_time_ns({10'000'000'000'000, 0}, {1'000'000'000'000, 1}), 10'000'000'000);
  EXPECT_EQ(load_time_ns({1'000'000'000'000, 0}, {1000, 1}), 1'000'000'000'000'000'000);
}

TEST(ModelledLoader, AnswersWhenTheModelSaysAndNotBefore) {
  BrokenZoneOne filler;
  ModelledLoader loader(20, kWork, kRates, &filler);
  loader.advance_to(5'000'000'000);
  loader.load({0, 3, 11});
  loader.advance_to(6'099'999'999);
  EXPECT_FALSE(loader.poll());
  EXPECT_TRUE(filler.filled.empty());
  loader.advance_to(6'100'000'000);
  const auto result = loader.poll();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->zone, 0u);
  EXPECT_EQ(result->generation, 3u);
  EXPECT_EQ(result->error.code, ErrorCode::kOk);
  EXPECT_EQ(result->slots.count, 11u);
  EXPECT_EQ(filler.filled[0].size(), 11u);
  EXPECT_EQ(loader.bytes_loaded(), 1000u);
  EXPECT_FALSE(loader.poll());
}

TEST(ModelledLoader, GivesUpAtTheEndOfTheChunkAndPutsTheSlotsBack) {
  ModelledLoader loader(20, kWork, kRates, nullptr);
  loader.load({0, 1, 11});
  loader.advance_to(250'000'000);  // in the third chunk
  loader.cancel();
  EXPECT_FALSE(loader.poll());
  loader.advance_to(300'000'000);
  const auto result = loader.poll();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->error.code, ErrorCode::kCancelled);
  EXPECT_EQ(result->slots.count, 0u);
  EXPECT_EQ(loader.pool().free_count(), 20u);
  EXPECT_EQ(loader.bytes_loaded(), 0u);
}

TEST(ModelledLoader, PutsTheSlotsOfADamagedZoneBack) {
  BrokenZoneOne filler;
  ModelledLoader loader(20, kWork, kRates, &filler);
  loader.load({1, 1, 11});
  loader.advance_to(2'000'000'000);
  EXPECT_EQ(loader.poll()->error, (Error{ErrorCode::kBadChecksum, 42}));
  EXPECT_EQ(loader.pool().free_count(), 20u);
}

TEST(ModelledLoader, CancelWithoutALoadDoesNothing) {
  ModelledLoader loader(1, kWork, kRates, nullptr);
  loader.cancel();
  EXPECT_FALSE(loader.poll());
}

TEST(ModelledLoader, WithoutSlotsGivesUpAtOnceAndChainsOnlyCount) {
  Catalog catalog;
  catalog.zones.resize(2);
  catalog.zones[1].stored_bytes = 1000;  // at 1000 bytes/s: 1 s
  ModelledLoader loader(catalog, {.storage = 1000, .decode = 1000});
  loader.take_back({0, 0, 7});  // of a zone that was resident before the loader was there
  loader.load({1, 4, 3});
  loader.advance_to(999'999'999);
  EXPECT_FALSE(loader.poll());
  loader.advance_to(1'000'000'000);
  const auto done = loader.poll();
  ASSERT_TRUE(done);
  EXPECT_EQ(done->error.code, ErrorCode::kOk);
  EXPECT_EQ(done->slots.count, 3u);
  EXPECT_EQ(loader.bytes_loaded(), 1000u);
  loader.load({1, 5, 3});
  loader.cancel();
  const auto cancelled = loader.poll();
  ASSERT_TRUE(cancelled);
  EXPECT_EQ(cancelled->error.code, ErrorCode::kCancelled);
  EXPECT_EQ(loader.bytes_loaded(), 1000u);
}

TEST(ModelledLoader, TakesTheWorkOfTheMapThatItIsToUse) {
  Catalog small, large;
  small.zones.resize(1);
  large.zones.resize(1);
  large.zones[0].stored_bytes = 2000;
  ModelledLoader loader(small, {.storage = 1000, .decode = 1000});
  loader.use(large);
  loader.load({0, 1, 1});
  loader.advance_to(1'999'999'999);
  EXPECT_FALSE(loader.poll());
  loader.advance_to(2'000'000'000);
  EXPECT_TRUE(loader.poll());
}

}  // namespace
}  // namespace zonepack
