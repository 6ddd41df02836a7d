// SPDX-License-Identifier: Apache-2.0
// The fuzz entries over changed copies of real packs and manifests, for machines without clang.
#include <gtest/gtest.h>

#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/mutate_seeds.hpp"
#include "tests/fuzz/seeds.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

TEST(Mutations, OfDecodedChunksDoNotLeadReadersAstray) {
  mutate_seeds(seeds().chunks, read_chunk, 60000);
}

TEST(Mutations, OfCompressedBlocksDoNotLeadReadersAstray) {
  mutate_seeds(seeds().blocks, read_block, 30000);
}

TEST(Mutations, OfIndexesDoNotLeadReadersAstray) {
  mutate_seeds(seeds().indexes, read_index, 30000);
}

TEST(Mutations, OfManifestsDoNotLeadReadersAstray) {
  mutate_seeds(seeds().manifests, read_manifest, 15000);
}

TEST(Mutations, OfDbcFilesDoNotLeadReadersAstray) { mutate_seeds(seeds().dbcs, read_dbc, 20000); }

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
