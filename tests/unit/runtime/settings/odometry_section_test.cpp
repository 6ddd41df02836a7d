// SPDX-License-Identifier: Apache-2.0
// Wheel models, units and CANopen nodes in the settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Signals a to d in frames 1 to 4, and the given section odometry.
LoadedSettings with(const std::string& odometry) {
  std::string text = "can:\n  signals:\n";
  for (int i = 1; i <= 4; ++i) {
    text += "    " + std::string(1, static_cast<char>('a' + i - 1)) +
            ": {id: " + std::to_string(i) + ", length: 32, type: signed}\n";
  }
  return parse_settings(text + "odometry: {" + odometry + "}\n", "a.yaml");
}

TEST(OdometrySection, EachUnitBecomesMetres) {
  struct Case {
    const char* keys;
    double metres;
  };
  constexpr double kTurn = 2 * kPi * 0.1;  // m, wheel radius 0.1 m
  for (const Case& c : {
           Case{"unit: metres", 1},
           Case{"unit: radians", 0.1},
           Case{"unit: turns, gear: 20", kTurn / 20},
           Case{"unit: rpm, gear: 10", kTurn / 60 / 10},
           Case{"unit: erpm, pole_pairs: 7, gear: 2", kTurn / 60 / 7 / 2},
           Case{"unit: ticks, ticks_per_turn: 4096", kTurn / 4096},
           Case{"unit: ticks, ticks_per_turn: 42, gear: 3, scale: 1.01", kTurn / 42 / 3 * 1.01},
       }) {
    const LoadedSettings loaded =
        with("model: wheel-speeds, left: a, right: b, wheel_radius: 0.1, " + std::string(c.keys));
    EXPECT_THAT(loaded.faults, IsEmpty()) << c.keys;
    const PerWheel& metres = loaded.settings.odometry.wheels.metres_per_unit;
    EXPECT_NEAR(metres[0], c.metres, 1e-15 + 1e-12 * c.metres) << c.keys;
    EXPECT_EQ(metres[0], metres[1]);
  }
}

TEST(OdometrySection, SidesHaveTheirOwnScaleAndSign) {
  const LoadedSettings loaded =
      with("left: a, right: b, scale: 2, scale_left: 0.75, scale_right: 1.25, invert: [right]");
  EXPECT_THAT(loaded.faults, IsEmpty());
  EXPECT_EQ(loaded.settings.odometry.wheels.metres_per_unit, (PerWheel{1.5, -2.5, 1, 1}));
}

TEST(OdometrySection, EveryModelNamesItsSignals) {
  const auto ids = [](const LoadedSettings& loaded) {
    EXPECT_THAT(loaded.faults, IsEmpty());
    std::vector<std::uint32_t> found;
    for (const CanSignal& s : signals_of(loaded.settings.odometry.wheels)) found.push_back(s.id);
    return found;
  };
  EXPECT_THAT(ids(with("model: twist, forward: c, yaw_rate: a")), ElementsAre(3, 1));
  const LoadedSettings car = with(
      "model: ackermann-speeds, forward: b, steering: d, unit: radians, wheel_radius: 0.2, "
      "wheelbase: 1.5, steering_offset: 0.1, invert: [steering]");
  EXPECT_THAT(ids(car), ElementsAre(2, 4));
  const WheelOdometrySettings& wheels = car.settings.odometry.wheels;
  EXPECT_EQ(wheels.metres_per_unit, (PerWheel{0.2, -1, 1, 1}));
  EXPECT_EQ(wheels.geometry.wheelbase_m, 1.5);
  EXPECT_EQ(wheels.steering_offset_rad, 0.1);
  const LoadedSettings mecanum = with(
      "model: mecanum-speeds, front_left: a, front_right: b, rear_left: c, rear_right: d, "
      "scale_left: 1.5, invert: [rear_right]");
  EXPECT_THAT(ids(mecanum), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(mecanum.settings.odometry.wheels.metres_per_unit, (PerWheel{1.5, 1, 1.5, -1}));
  const LoadedSettings omni = with(
      "model: omni-positions, around: [c, b, a], omni_radius: 0.3, omni_bearing: 1, invert: "
      "[\"2\"]");
  EXPECT_THAT(ids(omni), ElementsAre(3, 2, 1));
  EXPECT_EQ(omni.settings.odometry.wheels.metres_per_unit, (PerWheel{1, -1, 1, 1}));
  EXPECT_THAT(ids(with("model: omni-speeds, around: [a, b, c, d]")), ElementsAre(1, 2, 3, 4));
}

TEST(OdometrySection, WhatDoesNotGoTogetherIsNamed) {
  struct Case {
    const char *odometry, *fault;
  };
  for (const Case& c : {
           Case{"left: a, right: b, unit: rpm", "a.yaml:7: odometry.unit: rpm and erpm are speeds"},
           Case{"left: a, right: b, unit: ticks", "odometry.ticks_per_turn: missing"},
           Case{"left: a, right: b, gear: 5", "odometry.gear: has no meaning for metres"},
           Case{
               "left: a, right: b, invert: [lef]",
               "odometry.invert: \"lef\" is no signal of this model; did you mean \"left\"? Known: "
               "left, right"},
           Case{"model: twist, forward: a, yaw_rate: b, scale_left: 1.01",
                "odometry.scale_left: the model has no left and right side; use scale"},
           Case{"model: omni-speeds, around: [a, b]",
                "odometry.around: needs the signals of 3 or 4 wheels, has 2"},
           Case{"model: ackermann-speeds, forward: a",
                "odometry.steering: missing; this model needs it; known: a, b, c, d"},
           Case{"model: mecanum-speeds, front_left: a, front_right: b, rear_left: c",
                "odometry.rear_right: missing; this model needs it"},
       }) {
    EXPECT_THAT(with(c.odometry).faults, ElementsAre(HasSubstr(c.fault))) << c.odometry;
  }
}

LoadedSettings with_node(const std::string& node, const std::string& canopen = "") {
  return parse_settings("can:\n  canopen:\n    heartbeat_timeout: 0.4\n" + canopen +
                            "    nodes:\n      left: {node: 3, tpdo1: [0x60410010, 0x60640020]}\n"
                            "      right: {" +
                            node + "}\nodometry: {left: left.6064, right: right.6064}\n",
                        "a.yaml");
}

TEST(CanOpenSection, MappedObjectsBecomeSignalsAndNodesAreWatched) {
  const LoadedSettings loaded =
      with_node("node: 4, tpdo2: [0x00050008, 0x60640020, 0x21060210], tpdo2_id: 0x2A4",
                "    sync_timeout: 0.05\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  const auto& signals = loaded.settings.can.signals;
  EXPECT_EQ(signals.at("left.6041").type, SignalType::kUnsigned);
  EXPECT_EQ(signals.at("left.6064").id, 0x183u);
  EXPECT_EQ(signals.at("left.6064").bits, (SignalBits{16, 32, ByteOrder::kLittle}));
  EXPECT_EQ(signals.at("left.6064").type, SignalType::kSigned);
  // After 8 bits of padding.
  EXPECT_EQ(signals.at("right.6064").id, 0x2A4u);
  EXPECT_EQ(signals.at("right.6064").bits.start, 8);
  EXPECT_EQ(signals.at("right.2106sub2").bits, (SignalBits{40, 16, ByteOrder::kLittle}));
  EXPECT_EQ(signals.size(), 4u);
  const CanOpenWatchSettings& watch = loaded.settings.odometry.wheels.canopen;
  EXPECT_EQ(watch.node_count, 2u);
  EXPECT_EQ(watch.nodes[0], 3);
  EXPECT_EQ(watch.nodes[1], 4);
  EXPECT_EQ(watch.heartbeat_timeout_s, 0.4);
  EXPECT_EQ(watch.sync_timeout_s, 0.05);
  EXPECT_EQ(with_node("node: 4, heartbeat: false, tpdo1: [0x60640020]")
                .settings.odometry.wheels.canopen.node_count,
            1u);
}

TEST(CanOpenSection, WrongMappingsAreNamed) {
  struct Case {
    const char *node, *fault;
  };
  for (const Case& c : {
           Case{"node: 4, tpdo1: [0x6064]",
                "a.yaml:6: can.canopen.nodes.right.tpdo1: \"0x6064\" is "
                "not a mapped object; allowed: 0x, 4 digits of index"},
           Case{"node: 4, tpdo1: [0x60640000]", "\"0x60640000\" is not a mapped object"},
           Case{"node: 4, tpdo1: [0x60640020, 0x606C0020, 0x60410010]",
                "more than 64 bits with 0x60410010"},
           Case{"node: 4, tpdo1: [0x60640020], tpdo2: [0x60640020]",
                "there are two signals right.6064"},
           Case{"node: 128, tpdo1: [0x60640020]", "node: 128 is out of range; allowed: 1 to 127"},
           Case{"tpdo1: [0x60640020]", "can.canopen.nodes.right.node: missing"},
       }) {
    EXPECT_THAT(with_node(c.node).faults, Contains(HasSubstr(c.fault))) << c.node;
  }
}

}  // namespace
}  // namespace zonepack
