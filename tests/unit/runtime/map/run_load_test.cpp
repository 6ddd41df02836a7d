// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/run_load.hpp"

#include <gtest/gtest.h>

#include "platform/sim/sim_storage.hpp"
#include "tests/support/page_cache.hpp"
#include "tests/unit/runtime/map/two_zones.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kLoadMs = 1'000'000;

// A clock that sleeping advances, and a request to cancel at a time or after a number of queries.
class DrivenHost final : public LoadHost {
 public:
  std::int64_t now_ns() noexcept override { return now; }
  void sleep_until(std::int64_t time_ns) noexcept override {
    ++sleeps;
    now = cancel_at < time_ns ? cancel_at : time_ns;
  }
  bool cancelled() noexcept override { return now >= cancel_at || questions++ >= cancel_after; }

  void loaded(const ChunkRef&) noexcept override { ++chunks; }

  std::int64_t now = 1'000'000 * kLoadMs;
  std::int64_t cancel_at = INT64_MAX;
  int cancel_after = INT32_MAX;
  int questions = 0;
  int sleeps = 0;
  std::size_t chunks = 0;
};

TEST(RunLoad, WithoutALimitItNeverSleeps) {
  test_support::TwoZones map(8);
  DrivenHost host;
  RateLimit none(0);
  ZoneLoad load = map.begin(0, ReadMode::kBuffered).value();
  EXPECT_TRUE(run_load(load, none, host));
  EXPECT_EQ(host.sleeps, 0);
  EXPECT_EQ(host.chunks, load.chunks().size());
  EXPECT_EQ(load.stored_bytes_read(), map.catalog().zones[0].stored_bytes);
}

TEST(RunLoad, ALoadTakesAsLongAsItsBytesMayTake) {
  test_support::TwoZones map(8);
  for (const ReadMode mode : {ReadMode::kDirect, ReadMode::kBuffered}) {
    DrivenHost host;
    RateLimit limit(1'000'000);  // 1 byte in 1 us
    const std::int64_t start = host.now;
    ZoneLoad load = map.begin(0, mode).value();
    EXPECT_TRUE(run_load(load, limit, host));
    // All but the bucket's 64 KiB, which are there at once, take their time.
    EXPECT_EQ(host.now - start,
              static_cast<std::int64_t>(load.bytes_fetched() - kReadBufferBytes) * 1000);
    EXPECT_GE(load.bytes_fetched(), map.catalog().zones[0].stored_bytes);
  }
}

TEST(RunLoad, GivesUpBetweenAnyTwoChunksAndReadsNoFurther) {
  test_support::TwoZones map(8);
  const std::size_t all = [&] {
    ZoneLoad load = map.begin(0, ReadMode::kBuffered).value();
    EXPECT_TRUE(test_support::TwoZones::finish(load));
    return load.chunks().size();
  }();
  ASSERT_GT(all, 8u);
  for (std::size_t chunks = 0; chunks < all; ++chunks) {
    SimStorage disk;
    {
      DrivenHost host;
      host.cancel_after = static_cast<int>(chunks) * 2;  // asked twice for each chunk
      RateLimit none(0);
      ZoneLoad load = map.begin(0, ReadMode::kBuffered).value();
      EXPECT_EQ(run_load(load, none, host).error().code, ErrorCode::kCancelled);
      ASSERT_LE(load.chunks().size(), chunks);
      // Windows read so far hold less than one beyond the chunks that were decoded.
      ByteCount windows = 0;
      for (const SimStorage::Read& read : disk.reads()) windows += read.size;
      EXPECT_LT(windows, load.stored_bytes_read() + kReadBufferBytes + 8192);
    }
  }
}

TEST(RunLoad, GivesUpInTheMiddleOfAPause) {
  test_support::TwoZones map(8);
  DrivenHost host;
  RateLimit limit(1000);  // a window lasts a minute
  host.cancel_at = host.now + 5 * kLoadMs;
  ZoneLoad load = map.begin(0, ReadMode::kBuffered).value();
  EXPECT_EQ(run_load(load, limit, host).error().code, ErrorCode::kCancelled);
  EXPECT_EQ(host.now, host.cancel_at);
}

TEST(RunLoad, OneStepReadsAtMostOneBuffer) {
  test_support::TwoZones map(8);
  for (const ReadMode mode : {ReadMode::kDirect, ReadMode::kMapped, ReadMode::kBuffered}) {
    SimStorage disk;
    {
      ZoneLoad load = map.begin(0, mode).value();
      std::size_t before = disk.reads().size();
      for (bool more = true; more;) {
        more = *load.step();
        const auto reads = disk.reads();
        ASSERT_LE(reads.size(), before + 1);
        EXPECT_LE(reads.back().size, kReadBufferBytes);
        before = reads.size();
      }
    }
  }
}

// The most that the page cache held of a map's packs while all its zones were loaded, cold.
std::uint64_t most_page_cache(test_support::TwoZones& map, ReadMode mode) {
  std::uint64_t most = 0;
  for (int round = 0; round < 2; ++round) {
    for (const ZoneId zone : {0u, 1u}) {
      ZoneLoad load = map.begin(zone, mode).value();
      while (*load.step()) {
        const std::uint64_t now =
            test_support::cached_bytes(map.pack(0)) + test_support::cached_bytes(map.pack(1));
        most = std::max(most, now);
      }
    }
  }
  return most;
}

TEST(ColdLoads, LeaveNoMoreThanTheBoundInThePageCache) {
  test_support::TwoZones map(220);
  const std::uint64_t bytes =
      std::filesystem::file_size(map.pack(0)) + std::filesystem::file_size(map.pack(1));
  ASSERT_GT(bytes, StorageFile::kMostPageCache * 3 / 2);
  if (!test_support::make_cold(map.pack(0)) || !test_support::make_cold(map.pack(1))) {
    GTEST_SKIP() << "a file system in memory: nothing can be dropped";
  }
  for (const ReadMode mode : {ReadMode::kDirect, ReadMode::kMapped, ReadMode::kBuffered}) {
    EXPECT_LE(most_page_cache(map, mode), StorageFile::kMostPageCache);
    EXPECT_EQ(test_support::cached_bytes(map.pack(0)), 0u);
    EXPECT_EQ(test_support::cached_bytes(map.pack(1)), 0u);
  }
  EXPECT_GT(most_page_cache(map, ReadMode::kCached), StorageFile::kMostPageCache)
      << "without care there is more, and it shows";
}

}  // namespace
}  // namespace zonepack
