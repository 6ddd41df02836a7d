// SPDX-License-Identifier: Apache-2.0
#include "platform/base/json_text.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(JsonQuoted, EscapesWhatJsonForbids) {
  EXPECT_EQ(json_quoted("a\"b\\c\n\x01"), "\"a\\\"b\\\\c\\u000a\\u0001\"");
  EXPECT_EQ(json_quoted("Öffnung"), "\"Öffnung\"");
}

}  // namespace
}  // namespace zonepack
