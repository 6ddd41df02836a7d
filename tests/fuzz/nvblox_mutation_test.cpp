// SPDX-License-Identifier: Apache-2.0
// The entries of nvblox_entries.hpp over changed inputs.
#include <gtest/gtest.h>

#include "tests/fuzz/mutator.hpp"
#include "tests/fuzz/nvblox_entries.hpp"

namespace zonepack::fuzz {
namespace {

void mutate_nvblox(const std::vector<packer::Bytes>& seeds, bool (*entry)(ByteSpan),
                   std::size_t rounds) {
  ASSERT_FALSE(seeds.empty());
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(entry(seeds[i])) << "seed " << i;
  Mutator mutator(20261127);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < rounds; ++i) accepted += entry(mutator(seeds[i % seeds.size()]));
  EXPECT_GT(accepted, 0u);
  EXPECT_LT(accepted, rounds);
}

TEST(NvbloxMutations, OfBlocksOfVoxelsAreReadInsideTheirBytes) {
  mutate_nvblox(nvblox_seeds().voxels, read_voxels, 4'000);
}

TEST(NvbloxMutations, OfMapsEndInOrder) { mutate_nvblox(nvblox_seeds().files, read_nvblox, 1'000); }

TEST(NvbloxMutations, OfLayersEndInOrder) {
  mutate_nvblox(nvblox_seeds().layers, read_layers, 20'000);
}

}  // namespace
}  // namespace zonepack::fuzz
