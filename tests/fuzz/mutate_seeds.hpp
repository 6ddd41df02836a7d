// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "platform/base/byte_span.hpp"
#include "tests/fuzz/mutator.hpp"

namespace zonepack::fuzz {

// Every seed must pass as it is; of the changed ones some pass, so that reading goes deep, and some
// do not.
inline void mutate_seeds(const std::vector<packer::Bytes>& seeds, bool (*entry)(ByteSpan),
                         std::size_t rounds, std::uint64_t first = 20260101) {
  ASSERT_FALSE(seeds.empty());
  for (std::size_t i = 0; i < seeds.size(); ++i) EXPECT_TRUE(entry(seeds[i])) << "seed " << i;
  Mutator mutator(first);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < rounds; ++i) accepted += entry(mutator(seeds[i % seeds.size()]));
  EXPECT_GT(accepted, 0u);
  EXPECT_LT(accepted, rounds);
}

}  // namespace zonepack::fuzz
