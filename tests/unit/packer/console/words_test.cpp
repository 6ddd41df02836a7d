// SPDX-License-Identifier: Apache-2.0
#include "packer/console/words.hpp"

#include <gtest/gtest.h>

namespace zonepack::packer {
namespace {

TEST(Words, CountInSingularAndPlural) {
  EXPECT_EQ(counted(0, "zone"), "0 zones");
  EXPECT_EQ(counted(1, "zone"), "1 zone");
  EXPECT_EQ(counted(2, "trajectory", "trajectories"), "2 trajectories");
}

TEST(Words, GiveSizesInMiB) {
  EXPECT_EQ(mib_text(0), "0.00");
  EXPECT_EQ(mib_text(1), "0.01");  // something, so not nothing
  EXPECT_EQ(mib_text(kMiB * 3 / 2), "1.50");
  EXPECT_EQ(size_text(1), "1 byte");
  EXPECT_EQ(size_text(kMiB), "1048576 bytes (1.00 MiB)");
}

TEST(Words, OrderNamesAsAReaderDoes) {
  EXPECT_EQ(natural_order({"room10", "room2", "hall"}), (std::vector<std::size_t>{2, 1, 0}));
}

}  // namespace
}  // namespace zonepack::packer
