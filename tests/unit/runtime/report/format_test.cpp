// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/format.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace zonepack::report {
namespace {

TEST(Format, NumbersDropZerosButNotDigits) {
  EXPECT_EQ(format_number(1.50, 2), "1.5");
  EXPECT_EQ(format_number(100, 0), "100");
  EXPECT_EQ(format_number(100, 2), "100");
  EXPECT_EQ(format_number(-0.001, 2), "0");
  EXPECT_EQ(format_number(-2.675, 1), "-2.7");
  EXPECT_EQ(format_number(1e20, 1), "100000000000000000000");
}

TEST(Format, FixedNumbersKeepTheirZeros) {
  EXPECT_EQ(format_fixed(16, 1), "16.0");
  EXPECT_EQ(format_fixed(0.0004, 2), "0.00");
}

TEST(Format, WhatIsNotANumberIsADash) {
  EXPECT_EQ(format_number(std::numeric_limits<double>::quiet_NaN(), 2), "-");
  EXPECT_EQ(format_number(-std::numeric_limits<double>::infinity(), 2), "-");
}

TEST(Format, BytesHaveThreeDigitsAndABinaryUnit) {
  EXPECT_EQ(format_bytes(0), "0 B");
  EXPECT_EQ(format_bytes(1023), "1023 B");
  EXPECT_EQ(format_bytes(1024), "1 KiB");
  EXPECT_EQ(format_bytes(3.5 * 1024 * 1024), "3.5 MiB");
  EXPECT_EQ(format_bytes(96.26 * 1024 * 1024), "96.3 MiB");
  EXPECT_EQ(format_bytes(18446744073709551615.0), "16 EiB");  // 2^64 / 2^60
}

TEST(Format, SecondsBecomeMinutesAfterTwo) {
  EXPECT_EQ(format_seconds(110.52), "110.5 s");
  EXPECT_EQ(format_seconds(615), "10 min 15 s");
  EXPECT_EQ(format_seconds(179.7), "3 min 0 s");
}

TEST(Format, CountsAreGroupedByThree) {
  EXPECT_EQ(format_count(999), "999");
  EXPECT_EQ(format_count(1234567),
            "1\xE2\x80\x89"
            "234\xE2\x80\x89"
            "567");
}

TEST(Format, EscapesWhatXmlReservesAndKeepsTheRest) {
  EXPECT_EQ(escape_xml("<a b=\"c\">&'"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;");
  EXPECT_EQ(escape_xml("Stra\xC3\x9F"
                       "e \xE5\x8C\xBB"),
            "Stra\xC3\x9F"
            "e \xE5\x8C\xBB");
}

TEST(Format, DropsControlCharactersAndReplacesBrokenUtf8) {
  EXPECT_EQ(escape_xml(std::string_view("a\0b\x1b[1m\x7f", 8)), "ab[1m\x7f");
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(escape_xml("\xC3("), bad + "(");
  EXPECT_EQ(escape_xml("\xC0\xAF"), bad + bad);                      // overlong '/'
  EXPECT_EQ(escape_xml("\xED\xA0\x80"), bad + bad + bad);            // a surrogate
  EXPECT_EQ(escape_xml("\xEF\xBF\xBF"), bad + bad + bad);            // U+FFFF is no XML character
  EXPECT_EQ(escape_xml("\xF4\x90\x80\x80"), bad + bad + bad + bad);  // above U+10FFFF
  EXPECT_EQ(escape_xml("\xE5\x8C"), bad + bad);                      // cut off
}

TEST(Format, WidthCountsCharactersNotBytes) {
  EXPECT_DOUBLE_EQ(text_width_em("il"), 0.56);        // 0.28 + 0.28
  EXPECT_DOUBLE_EQ(text_width_em("\xC3\x9F"), 0.65);  // one character of two bytes
  EXPECT_GT(text_width_em("il", true), text_width_em("il"));
}

TEST(Format, ShortensBetweenCharacters) {
  EXPECT_EQ(shorten_text("aaa", 2), "aaa");  // 1.83 em
  // "..." is 0.96 em wide, so that one "a" of 0.61 em fits into 2 em, and no broken character ever.
  EXPECT_EQ(shorten_text("aaaa", 2), "a...");
  EXPECT_EQ(shorten_text("a\xC3\x9F\xC3\x9F", 2.5), "a\xC3\x9F\xC3\x9F");
  EXPECT_EQ(shorten_text("a\xC3\x9F\xC3\x9F\xC3\x9F", 2.3), "a\xC3\x9F...");
  EXPECT_EQ(shorten_text("west ward", 3.7), "west...");
  EXPECT_EQ(shorten_text("west", 0), "...");
}

TEST(Format, WrapsAtBlanksAndKeepsEveryWord) {
  // "aaa" is 1.83 em wide, a blank 0.32.
  EXPECT_EQ(wrap_text("aaa aaa  aaa", 4), (std::vector<std::string>{"aaa aaa", "aaa"}));
  EXPECT_EQ(wrap_text("aaaaaaaaaa a", 1), (std::vector<std::string>{"aaaaaaaaaa", "a"}));
  EXPECT_TRUE(wrap_text("", 10).empty());
}

}  // namespace
}  // namespace zonepack::report
