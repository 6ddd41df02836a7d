// SPDX-License-Identifier: Apache-2.0
#include "platform/base/utf8.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(Utf8, MeasuresTheShortestAndLongestCharacterOfEachLength) {
  EXPECT_EQ(utf8_length(std::string_view("\0", 1)), 1u);  // U+0000
  EXPECT_EQ(utf8_length("\x7F"), 1u);
  EXPECT_EQ(utf8_length("\xC2\x80"), 2u);  // U+0080
  EXPECT_EQ(utf8_length("\xDF\xBF"), 2u);
  EXPECT_EQ(utf8_length("\xE0\xA0\x80"), 3u);  // U+0800
  EXPECT_EQ(utf8_length("\xEF\xBF\xBF"), 3u);
  EXPECT_EQ(utf8_length("\xF0\x90\x80\x80"), 4u);  // U+10000
  EXPECT_EQ(utf8_length("\xF4\x8F\xBF\xBF"), 4u);  // U+10FFFF
}

TEST(Utf8, RefusesWhatRfc3629Forbids) {
  EXPECT_EQ(utf8_length(""), 0u);
  EXPECT_EQ(utf8_length("\x80"), 0u);              // a lone continuation
  EXPECT_EQ(utf8_length("\xC1\xBF"), 0u);          // overlong U+007F
  EXPECT_EQ(utf8_length("\xE0\x9F\xBF"), 0u);      // overlong U+07FF
  EXPECT_EQ(utf8_length("\xF0\x8F\xBF\xBF"), 0u);  // overlong U+FFFF
  EXPECT_EQ(utf8_length("\xED\xA0\x80"), 0u);      // a surrogate
  EXPECT_EQ(utf8_length("\xF4\x90\x80\x80"), 0u);  // above U+10FFFF
  EXPECT_EQ(utf8_length("\xF5\x80\x80\x80"), 0u);
  EXPECT_EQ(utf8_length("\xE5\x8C"), 0u);   // cut off
  EXPECT_EQ(utf8_length("\xE5\x8Cx"), 0u);  // interrupted
}

TEST(Utf8, JudgesAndCountsWholeTexts) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(
      is_utf8("K\xC3\xBC"
              "che \xF0\x9F\xA4\x96"));
  EXPECT_FALSE(is_utf8("room \xFF"));
  EXPECT_EQ(utf8_width("K\xC3\xBC"
                       "che"),
            5u);
}

}  // namespace
}  // namespace zonepack
