// SPDX-License-Identifier: Apache-2.0
#include "platform/base/shell_word.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(ShellWord, IsQuotedOnlyWhereAShellNeedsIt) {
  EXPECT_EQ(shell_word("maps/ward-2.zpk"), "maps/ward-2.zpk");
  EXPECT_EQ(shell_word("my map"), "'my map'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("$HOME;"), "'$HOME;'");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_quoted("map.db"), "'map.db'");
}

}  // namespace
}  // namespace zonepack
