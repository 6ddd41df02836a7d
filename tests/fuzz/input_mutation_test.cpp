// SPDX-License-Identifier: Apache-2.0
// The entries of input_entries.hpp over changed inputs and the kept corpora, under a bound of
// memory each.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>

#include "platform/base/byte_count.hpp"
#include "platform/memory/foreign_heap.hpp"
#include "tests/fuzz/input_entries.hpp"
#include "tests/fuzz/input_seeds.hpp"
#include "tests/fuzz/mutator.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;
using Entry = bool (*)(ByteSpan);

#ifdef ZONEPACK_FOREIGN_HEAP
constexpr bool kOwnHeap = false;
#else
constexpr bool kOwnHeap = true;
#endif

// The most memory this process had resident so far.
ByteCount peak() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<ByteCount>(usage.ru_maxrss) * kKiB;
}

// Every seed must pass as it is; of the changed ones some pass, so that reading goes deep, and some
// do not. Inputs of the corpus only have to end.
void mutate(const std::vector<Bytes>& seeds, const std::string& kind, Entry entry,
            std::size_t rounds, ByteCount bound) {
  ASSERT_FALSE(seeds.empty());
  const std::vector<Bytes> kept = corpus(kind);
  EXPECT_FALSE(kept.empty());
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(entry(seeds[i])) << "seed " << i;
  const ByteCount before = peak();
  for (const Bytes& input : kept) entry(input);
  Mutator mutator(20260102);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < rounds; ++i) accepted += entry(mutator(seeds[i % seeds.size()]));
  for (std::size_t i = 0; i < rounds / 10; ++i) entry(mutator(kept[i % kept.size()]));
  EXPECT_GT(accepted, 0u);
  EXPECT_LT(accepted, rounds);
  if (kOwnHeap) {
    EXPECT_LT(peak() - before, bound) << "bytes over what the seeds took";
  }
}

TEST(InputMutations, OfZoneFilesEndInOrder) {
  mutate(input_seeds().geojson, "geojson", read_geojson, 20'000, 48 * kMiB);
}

TEST(InputMutations, OfSettingsEndInOrder) {
  mutate(input_seeds().settings, "settings", read_settings, 4'000, 32 * kMiB);
}

TEST(InputMutations, OfDatabasesEndInOrder) {
  mutate(input_seeds().sqlite, "sqlite", read_sqlite, 4'000, 48 * kMiB);
}

TEST(InputMutations, OfMessagePackMapsEndInOrder) {
  mutate(input_seeds().msgpack, "msgpack", read_msgpack, 5'000, 16 * kMiB);
}

TEST(InputMutations, OfPointCloudsEndInOrder) {
  mutate(input_seeds().pcd, "pcd", read_pcd, 2'000, 24 * kMiB);
}

TEST(InputMutations, OfRecordingsEndInOrder) {
  mutate(input_seeds().recordings, "recording", read_recording, 3'000, 16 * kMiB);
}

TEST(InputMutations, OfMessagesEndInOrder) {
  mutate(input_seeds().messages, "protocol", read_message, 100'000, 8 * kMiB);
}

TEST(InputMutations, OfNothingAreRefused) {
  for (const Entry entry : {read_geojson, read_settings, read_sqlite, read_msgpack, read_pcd,
                            read_recording, read_message}) {
    EXPECT_FALSE(entry({}));
  }
}

}  // namespace
}  // namespace zonepack::fuzz
