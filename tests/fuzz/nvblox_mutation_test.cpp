// SPDX-License-Identifier: Apache-2.0
// The entries of nvblox_entries.hpp over changed inputs.
#include <gtest/gtest.h>

#include "tests/fuzz/input_entries.hpp"
#include "tests/fuzz/mutate_seeds.hpp"
#include "tests/fuzz/nvblox_entries.hpp"

namespace zonepack::fuzz {
namespace {

constexpr std::uint64_t kFirst = 20261127;

TEST(NvbloxMutations, OfBlocksOfVoxelsAreReadInsideTheirBytes) {
  mutate_seeds(nvblox_seeds().voxels, read_voxels, 4'000, kFirst);
}

TEST(NvbloxMutations, OfMapsEndInOrder) {
  mutate_seeds(nvblox_seeds().files, read_nvblox, 1'000, kFirst);
}

TEST(NvbloxMutations, OfLayersEndInOrder) {
  mutate_seeds(nvblox_seeds().layers, read_layers, 20'000, kFirst);
}

}  // namespace
}  // namespace zonepack::fuzz
