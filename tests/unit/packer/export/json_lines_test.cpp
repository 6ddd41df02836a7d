// SPDX-License-Identifier: Apache-2.0
#include "packer/export/json_lines.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

namespace zonepack::packer {
namespace {

template <typename Write>
std::string written(Write&& write) {
  std::string text;
  JsonLines json([&](std::string_view piece) { text += piece; });
  write(json);
  json.flush();
  return text;
}

std::string number_text(double value) {
  return written([&](JsonLines& json) { json.number(value); });
}

TEST(JsonLines, PrintsDoublesSoThatEveryBitReadsBack) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const double back = nlohmann::json::parse(number_text(value)).get<double>();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value)) << value;
  }
}

TEST(JsonLines, PrintsFloatsAsTheDoubleThatSqliteHolds) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    const double back = nlohmann::json::parse(number_text(value)).get<double>();
    ASSERT_EQ(std::bit_cast<std::uint64_t>(back),
              std::bit_cast<std::uint64_t>(static_cast<double>(value)));
  }
  // 0.1f is 0.100000001490116119384765625; 17 digits distinguish its double from all others.
  EXPECT_EQ(number_text(0.1f), "0.10000000149011612");
}

TEST(JsonLines, KeepsTheSignOfZeroAndNamesWhatIsNoNumber) {
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(-0.0), "-0.0");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "\"nan\"");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "\"inf\"");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "\"-inf\"");
}

TEST(JsonLines, EncodesBytesAsRfc4648Does) {
  // The test vectors of RFC 4648, section 10.
  const std::pair<std::string, std::string> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& vector : vectors) {
    const auto bytes = std::as_bytes(std::span(vector.first));
    EXPECT_EQ(written([&](JsonLines& json) { json.base64(bytes); }), '"' + vector.second + '"');
  }
}

TEST(JsonLines, WritesTextThatAnyReaderTakes) {
  const auto text = [](std::string_view value) {
    return written([&](JsonLines& json) { json.text(value); });
  };
  EXPECT_EQ(text("Flur \"A\" \\ 2\n\x1f"), R"("Flur \"A\" \\ 2\u000a\u001f")");
  EXPECT_EQ(text("Küche \U0001F6AA"), "\"Küche \U0001F6AA\"");
  // A lone continuation, a cut sequence, an overlong slash, a surrogate, past U+10FFFF.
  EXPECT_EQ(text("\x80"), R"("\ufffd")");
  EXPECT_EQ(text("\xE2\x82"), R"("\ufffd\ufffd")");
  EXPECT_EQ(text("\xC0\xAF"), R"("\ufffd\ufffd")");
  EXPECT_EQ(text("\xED\xA0\x80"), R"("\ufffd\ufffd\ufffd")");
  EXPECT_EQ(text("\xF4\x90\x80\x80"), R"("\ufffd\ufffd\ufffd\ufffd")");
}

TEST(JsonLines, SeparatesMembersAndEndsLines) {
  const std::string text = written([](JsonLines& json) {
    for (int line = 0; line < 2; ++line) {
      json.begin_object();
      json.key("a");
      json.begin_array();
      json.integer(-1);
      json.null();
      json.begin_array();
      json.end_array();
      json.end_array();
      json.key("b");
      json.numbers(std::array<float, 2>{1.5f, 2.0f});
      json.end_object();
      json.end_line();
    }
  });
  const std::string line = R"({"a":[-1,null,[]],"b":[1.5,2]})";
  EXPECT_EQ(text, line + "\n" + line + "\n");
}

}  // namespace
}  // namespace zonepack::packer
