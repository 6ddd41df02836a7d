// SPDX-License-Identifier: Apache-2.0
// The fuzz entries over changed copies of real packs and manifests, for machines without clang.
#include <gtest/gtest.h>

#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/seeds.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

// Every seed must pass as it is; of the changed ones some pass, so that reading goes deep, and some
// do not.
void mutate(const std::vector<Bytes>& seeds, bool (*entry)(ByteSpan), std::size_t rounds) {
  ASSERT_FALSE(seeds.empty());
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(entry(seeds[i])) << "seed " << i;
  Mutator mutator(20260101);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < rounds; ++i) accepted += entry(mutator(seeds[i % seeds.size()]));
  EXPECT_GT(accepted, 0u);
  EXPECT_LT(accepted, rounds);
}

TEST(Mutations, OfDecodedChunksDoNotLeadReadersAstray) {
  mutate(seeds().chunks, read_chunk, 60000);
}

TEST(Mutations, OfCompressedBlocksDoNotLeadReadersAstray) {
  mutate(seeds().blocks, read_block, 30000);
}

TEST(Mutations, OfIndexesDoNotLeadReadersAstray) { mutate(seeds().indexes, read_index, 30000); }

TEST(Mutations, OfManifestsDoNotLeadReadersAstray) {
  mutate(seeds().manifests, read_manifest, 15000);
}

TEST(Mutations, OfDbcFilesDoNotLeadReadersAstray) { mutate(seeds().dbcs, read_dbc, 20000); }

TEST(Mutations, OfWholePacksAreAllFound) {
  const std::vector<Bytes>& packs = seeds().packs;
  Mutator mutator(7);
  for (std::size_t i = 0; i < 3000; ++i) {
    const Bytes& pack = packs[i % packs.size()];
    const Bytes changed = mutator(pack);
    EXPECT_EQ(read_pack(changed), changed == pack) << "round " << i;
  }
}

TEST(Mutations, OfNothingAreRefused) {
  for (bool (*entry)(ByteSpan) : {read_pack, read_index, read_chunk, read_block, read_manifest}) {
    EXPECT_FALSE(entry({}));
  }
}

}  // namespace
}  // namespace zonepack::fuzz
