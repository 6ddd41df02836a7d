// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/gpio_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Read {
  GpioSettings gpio;
  std::vector<std::string> faults;
};

Read read(const std::string& text) {
  FaultList faults("a.yaml");
  Read read;
  YamlSection file(YAML::Load(text), "", faults);
  read_gpio(file, read.gpio, faults);
  read.faults = faults.take();
  return read;
}

TEST(GpioSection, ReadsEveryKindOfLine) {
  const auto [gpio, faults] = read(R"(
gpio:
  heartbeat_period: 0.5
  map_ready: {chip: robot, line: 2}
  fault: {chip: robot, line: 3, active_low: true, safe: inactive}
  dock: {chip: gpiochip1, line: DOCK, bias: pull-up, active_low: true, debounce: 0.1, x: 1, y: -2,
         yaw: 3.5, sigma: 0.01, sigma_yaw: 0.03}
  hold: {chip: robot, line: 6}
  zone_markers:
    door: {chip: robot, line: 7, zones: [A, B], reach: 2}
    lift: {chip: robot, line: 8, zones: [C]}
)");
  EXPECT_THAT(faults, IsEmpty());
  EXPECT_EQ(gpio.heartbeat_s, 0.5);
  EXPECT_EQ(gpio.map_ready->line, "2");
  EXPECT_EQ(gpio.map_ready->safe, SafeLevel::kUsual);
  EXPECT_TRUE(gpio.fault->active_low);
  EXPECT_EQ(gpio.fault->safe, SafeLevel::kInactive);
  EXPECT_FALSE(gpio.heartbeat);
  EXPECT_EQ(gpio.dock->input.line, "DOCK");
  EXPECT_EQ(gpio.dock->input.bias, GpioBias::kPullUp);
  EXPECT_EQ(gpio.dock->place.y_m, -2);
  EXPECT_EQ(gpio.hold->debounce_s, 0.02);
  ASSERT_EQ(gpio.markers.size(), 2u);
  EXPECT_EQ(gpio.markers[0].name, "door");
  EXPECT_THAT(gpio.markers[0].place.zones, ElementsAre("A", "B"));
  EXPECT_EQ(gpio.markers[1].place.reach_m, 1);

  Settings settings;
  settings.gpio = gpio;
  const CycleConfig config = cycle_config(settings);
  ASSERT_TRUE(config.dock);
  EXPECT_NEAR(config.dock->T_map_base.yaw_rad, 3.5 - 2 * 3.14159265358979, 1e-12);
  EXPECT_EQ(config.dock->sigma_rad, 0.03);
  ASSERT_EQ(config.markers.size(), 2u);
  EXPECT_EQ(config.markers[0].other, "B");
  EXPECT_EQ(config.markers[1].other, "");
}

TEST(GpioSection, IsEmptyByDefault) {
  const auto [gpio, faults] = read("can: {}");
  EXPECT_THAT(faults, IsEmpty());
  EXPECT_FALSE(gpio.any());
}

TEST(GpioSection, NamesWhatIsMissingWrongOrThereTwice) {
  struct Case {
    const char *line, *fault;
  };
  for (const Case& c : {
           Case{"map_ready: {line: 2}", "gpio.map_ready.chip: missing; a chip's label"},
           Case{"map_ready: {chip: robot}", "gpio.map_ready.line: missing; a line's number"},
           Case{"map_ready: {chip: a, line: 2, bias: none}", "gpio.map_ready.bias: unknown key"},
           Case{"map_ready: {chip: a, line: 2, safe: high}", "not one of: usual, active, inactive"},
           Case{"hold: {chip: a, line: 2, bias: up}",
                "not one of: as-is, none, pull-up, pull-down"},
           Case{"dock: {chip: a, line: 2, x: 1, y: 2}", "gpio.dock.yaw: missing; where base_link"},
           Case{"zone_markers: {d: {chip: a, line: 2}}", "gpio.zone_markers.d.zones: expected the"},
           Case{"zone_markers: {d: {chip: a, line: 2, zones: [A, A]}}", "expected the two zones"},
           Case{"zone_markers: {d: {chip: a, line: 2, zones: [A, B, C]}}", "expected the two"},
           Case{"{hold: {chip: a, line: 2}, fault: {chip: a, line: 2}}",
                "line 2 of chip a is named twice, first at gpio.fault"},
           Case{"holt: {chip: a, line: 2}", "gpio.holt: unknown key; did you mean \"hold\"?"},
           Case{"map_ready: 3", "gpio.map_ready"},
       }) {
    const std::string text =
        *c.line == '{' ? std::string("gpio: ") + c.line : std::string("gpio:\n  ") + c.line;
    EXPECT_THAT(read(text).faults, testing::Contains(HasSubstr(c.fault))) << c.line;
  }
  std::string many = "gpio:\n  zone_markers:\n";
  for (int i = 0; i < 33; ++i) {
    const std::string n = std::to_string(i);
    many += "    m" + n + ": {chip: a, line: " + n + ", zones: [A]}\n";
  }
  EXPECT_THAT(read(many).faults, ElementsAre(HasSubstr("gpio.zone_markers: at most 32 markers")));
}

}  // namespace
}  // namespace zonepack
