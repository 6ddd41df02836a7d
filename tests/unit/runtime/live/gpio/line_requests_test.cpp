// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/line_requests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/sim/sim_gpio.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LineRequests : public testing::Test {
 protected:
  LineRequests() {
    chips.add_chip("robot", 8);
    gpio.map_ready = OutputLine{.chip = "robot", .line = "0"};
    gpio.fault = OutputLine{.chip = "robot", .line = "1", .active_low = true};
    gpio.hold = InputLine{.chip = "robot", .line = "2"};
  }
  SimGpio chips;
  GpioSettings gpio;
};

TEST_F(LineRequests, ListLinesAsTheyAreFoundWithoutTouchingThem) {
  const auto findings = inspect_lines(chips, gpio);
  ASSERT_EQ(findings.size(), 3u);
  EXPECT_EQ(findings[0].name, "line map_ready");
  EXPECT_EQ(findings[0].found, "gpiochip0 (robot), line 0, free for output");
  EXPECT_EQ(findings[2].found, "gpiochip0 (robot), line 2, free for input");
  for (unsigned line = 0; line < 3; ++line) EXPECT_EQ(chips.changes("robot", line), 0u);
  chips.occupy("robot", 0, "gpioset");
  chips.make_output("robot", 2);
  gpio.fault->chip = "nowhere";
  const auto wrong = inspect_lines(chips, gpio);
  EXPECT_THAT(wrong[0].fault, HasSubstr("gpio.map_ready: line 0 of chip robot: held by gpioset"));
  EXPECT_THAT(wrong[1].fault, HasSubstr("gpio.fault: chip nowhere: not found"));
  EXPECT_THAT(wrong[2].fault, HasSubstr("gpio.hold: line 2 of chip robot: set up as an output"));
}

TEST_F(LineRequests, SafeOutputsAreSetEvenBesideOneThatCannotBe) {
  chips.drive("robot", 0, true);
  chips.drive("robot", 1, true);
  EXPECT_THAT(set_safe_outputs(chips, gpio), IsEmpty());
  EXPECT_FALSE(chips.is_high("robot", 0));
  EXPECT_FALSE(chips.is_high("robot", 1));  // fault: active, which is low
  chips.drive("robot", 1, true);
  gpio.map_ready->line = "77";
  EXPECT_THAT(set_safe_outputs(chips, gpio),
              ElementsAre(HasSubstr("gpio.map_ready: line 77 of chip robot")));
  EXPECT_FALSE(chips.is_high("robot", 1));
}

}  // namespace
}  // namespace zonepack
