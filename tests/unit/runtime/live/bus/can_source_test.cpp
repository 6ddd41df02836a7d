// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_source.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(CanSource, TellsALogItsFileAndItsSpeed) {
  const auto source = parse_can_source("log:run/can0.log@50");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->kind, CanSourceChoice::Kind::kLog);
  EXPECT_EQ(source->name, "run/can0.log");
  EXPECT_EQ(source->speed, 50);
  EXPECT_EQ(parse_can_source("log:a.log")->speed, 1);
  EXPECT_EQ(parse_can_source("sim:a.yaml@0.5")->speed, 0.5);
  EXPECT_EQ(parse_can_source("socketcan:can0")->name, "can0");
}

TEST(CanSource, TakesAnAtThatNoNumberFollowsAsPartOfTheName) {
  EXPECT_EQ(parse_can_source("log:me@home/can0.log")->name, "me@home/can0.log");
  EXPECT_EQ(parse_can_source("log:me@home/can0.log@2")->name, "me@home/can0.log");
}

TEST(CanSource, RefusesOtherTexts) {
  for (const char* text :
       {"", "can0", "log:", "log:@2", "file:a", "log:a@0", "log:a@-1", "log:a@1e9", "log:a@nan"}) {
    EXPECT_FALSE(parse_can_source(text)) << text;
  }
}

}  // namespace
}  // namespace zonepack
