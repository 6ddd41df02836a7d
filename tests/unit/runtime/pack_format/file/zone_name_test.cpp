// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/zone_name.hpp"

#include <gtest/gtest.h>

#include <string>

namespace zonepack {
namespace {

TEST(ZoneName, RefusesWhatATerminalOrJsonCannotCarry) {
  EXPECT_EQ(name_fault("Chirurgie Süd"), std::nullopt);
  EXPECT_EQ(name_fault("a\x1b[2Jb"), NameFault::kNotPlain);
  EXPECT_EQ(name_fault("a\xff"), NameFault::kNotPlain);      // no UTF-8
  EXPECT_EQ(name_fault("a\xc2\x9b"), NameFault::kNotPlain);  // U+009B begins a sequence like ESC [
  EXPECT_EQ(name_fault("a\xc2\xa0"), std::nullopt);          // U+00A0 is no control character
  EXPECT_EQ(name_fault(std::string("a\0b", 3)), NameFault::kNotPlain);
}

TEST(ZoneName, HasTheRuleOfThePacker) {
  EXPECT_EQ(name_fault(""), NameFault::kEmpty);
  EXPECT_EQ(name_fault(std::string(64, 'x')), std::nullopt);
  EXPECT_EQ(name_fault(std::string(65, 'x')), NameFault::kTooLong);
  EXPECT_EQ(name_fault(".hidden"), NameFault::kDot);
  EXPECT_EQ(name_fault("hall "), NameFault::kBlank);
  EXPECT_EQ(name_fault("a/b"), NameFault::kSeparator);
}

TEST(PlainText, MayBeEmpty) { EXPECT_TRUE(is_plain_text("")); }

}  // namespace
}  // namespace zonepack
