// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/field.hpp"

namespace zonepack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kExample = ZONEPACK_SOURCE_DIR "/config/agilex.yaml";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The example with `from`, which must be there, replaced.
LoadedSettings changed(const std::string& from, const std::string& to) {
  std::string text = text_of(kExample);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return parse_settings(text, "dir/robot.yaml");
}

TEST(Settings, TheExampleNeedsNoEdit) {
  const LoadedSettings loaded = load_settings(kExample);
  EXPECT_THAT(loaded.faults, IsEmpty());
  const WheelOdometrySettings& wheels = loaded.settings.odometry.wheels;
  EXPECT_EQ(wheels.signals[0].id, 0x311u);
  EXPECT_EQ(wheels.signals[0].bits, (SignalBits{7, 32, ByteOrder::kBig}));
  EXPECT_EQ(wheels.signals[1].bits, (SignalBits{39, 32, ByteOrder::kBig}));
  EXPECT_EQ(wheels.signals[0].type, SignalType::kSigned);
  EXPECT_EQ(wheels.signals[0].factor, 0.001);
  EXPECT_EQ(wheels.metres_per_unit[0], 1);
  EXPECT_EQ(loaded.settings.can.interface, "can0");
  EXPECT_EQ(loaded.settings.can.signals.size(), 4u);
  EXPECT_EQ(loaded.settings.map.path, "");
}

bool are_equal(const FieldValue& a, const FieldValue& b) {
  return std::visit(
      [&](auto* value) {
        const auto* other = std::get<decltype(value)>(b);
        if constexpr (std::is_same_v<decltype(value), PayloadChoice*>) {
          return value->mask == other->mask;
        } else {
          return *value == *other;
        }
      },
      a);
}

// Every key of a table is in the example, and its value there is the default.
template <typename Section>
void expect_defaults(const char* name, const Fields<Section>& fields, const Section& loaded) {
  const std::string text = text_of(kExample);
  Section defaults{}, read = loaded;
  for (const Field<Section>& field : fields) {
    EXPECT_THAT(text, HasSubstr("  " + (std::string(field.key) + ": "))) << name;
    EXPECT_TRUE(are_equal(field.value(read), field.value(defaults)))
        << name << "." << field.key << " differs from its default";
  }
}

TEST(Settings, TheExampleShowsEveryKeyWithItsDefault) {
  const Settings loaded = load_settings(kExample).settings;
  expect_defaults("map", map_fields(), loaded.map);
  EXPECT_THAT(text_of(kExample), HasSubstr("# budget: "));
  EXPECT_EQ(loaded.memory.budget, std::nullopt);
  EXPECT_EQ(loaded.memory.payload.mask, MemorySettings{}.payload.mask);
  EXPECT_EQ(loaded.memory.max_signatures, 0u);
  expect_defaults("loading", loading_fields(), loaded.loading);
  expect_defaults("odometry", wheel_fields(), loaded.odometry.wheels);
  expect_defaults("odometry", geometry_fields(), loaded.odometry.wheels.geometry);
  EXPECT_EQ(loaded.odometry.wheel_radius_m, OdometrySettings{}.wheel_radius_m);
  expect_defaults("pose", pose_fields(), loaded.pose);
  expect_defaults("zones", zones_fields(), loaded.zones);
  expect_defaults("preload", preload_fields(), loaded.preload);
  expect_defaults("cycle", cycle_fields(), loaded.cycle);
  expect_defaults("gpio", gpio_fields(), loaded.gpio);
  EXPECT_FALSE(loaded.gpio.any());
}

TEST(Settings, TheReferenceListsWhatTheTablesHold) {
  const std::string file = ZONEPACK_SOURCE_DIR "/config/SETTINGS.md";
  const bool same = text_of(file) == settings_reference();
  const std::string made = testing::TempDir() + "SETTINGS.md";
  if (!same) std::ofstream(made) << settings_reference();
  EXPECT_TRUE(same) << file << " is not what the tables say; that is now in " << made;
}

TEST(Settings, AnUnknownKeyIsNamedWithItsLineAndTheNearestKnownOne) {
  const LoadedSettings loaded =
      parse_settings("can: {interface: can0}\ncycle:\n  period_hs: 50\n", "a.yaml");
  EXPECT_THAT(
      loaded.faults,
      testing::Contains("a.yaml:3: cycle.period_hs: unknown key; did you mean \"period_hz\"? "
                        "Known: period_hz, most_frames"));
  EXPECT_THAT(changed("memory:", "memry:").faults,
              testing::Contains(AllOf(HasSubstr("memry: unknown key"), HasSubstr("\"memory\""))));
}

TEST(Settings, AWrongTypeOrRangeSaysWhatIsAllowed) {
  struct Case {
    const char *from, *to, *fault;
  };
  for (const Case& c : {
           Case{"track: 0.413", "track: wide",
                "odometry.track: \"wide\" is not a number; allowed: 0.01 to 20 m"},
           Case{"track: 0.413", "track: \"0.413\"", "odometry.track: \"0.413\" is not a number"},
           Case{"track: 0.413", "track: -1",
                "odometry.track: -1 is out of range; allowed: 0.01 to 20 m"},
           Case{"track: 0.413", "track: .nan", "odometry.track: \".nan\" is not a number"},
           Case{"track: 0.413", "track: [0.4]", "odometry.track: a list is not a number"},
           Case{"track: 0.413", "track: 0,413", "odometry.track: \"0,413\" is not a number"},
           Case{"period_hz: 100", "period_hz: 0", "cycle.period_hz: 0 is out of range"},
           Case{"max_signatures: 0", "max_signatures: 1.5", "\"1.5\" is not a whole number"},
           Case{"max_signatures: 0", "max_signatures: -1", "\"-1\" is out of range"},
           Case{"# budget: 24MiB", "budget: 24Mb", "memory.budget: \"24Mb\" is not a size"},
           Case{"# budget: 24MiB", "budget: 0", "memory.budget: \"0\" is not a size"},
           Case{"[features, scan, grid, blocks]", "[features, scam]",
                "memory.payload: \"scam\" is not a payload"},
           Case{"[features, scan, grid, blocks]", "features",
                "memory.payload: \"features\" where a list"},
           Case{"pinned: []", "pinned: L1", "memory.pinned: \"L1\" where a list"},
           Case{"model: differential-positions", "model: ackermann",
                "\"ackermann\" is not one of: differential-positions, wheel-speeds, twist"},
           Case{"byte_order: big", "byte_order: motorola", "is not one of: little, big"},
           Case{"id: 0x311", "id: 0x911", "can.signals.left_position: no such signal fits a frame"},
           Case{"id: 0x311", "id: 3.5", "is not a whole number"},
           Case{"id: 0x311", "extended: false",
                "can.signals.left_position: no such signal fits a frame"},
           Case{"length: 32", "length: 65", "length: 65 is out of range; allowed: 1 to 64 bits"},
           Case{"left: left_position", "left: left_wheel",
                "no signal \"left_wheel\" in can.signals"},
           Case{"least_depth: 0.05", "least_depth: 0.5", "must not be over zones.most_depth"},
           Case{"timeout: 0.3", "timeout: 0.01", "must be at least two cycles"},
       }) {
    const LoadedSettings loaded = changed(c.from, c.to);
    EXPECT_THAT(loaded.faults,
                ElementsAre(AllOf(testing::StartsWith("dir/robot.yaml"), HasSubstr(c.fault))))
        << c.to;
  }
}

TEST(Settings, ReportsAllFaultsAtOnceWithTheirLines) {
  std::string text = text_of(kExample);
  text += "cycle:\n  period_hz: 1\npose: 3\n";
  const LoadedSettings loaded = parse_settings(text, "a.yaml");
  EXPECT_THAT(loaded.faults, ElementsAre(HasSubstr(": cycle: stands here twice, first on line "),
                                         HasSubstr(": pose: stands here twice")));
  const LoadedSettings twice =
      parse_settings("map:\n  path: a\n  path: b\nfoo: 1\nbar: 2\n", "a.yaml");
  EXPECT_THAT(twice.faults,
              testing::Contains("a.yaml:3: map.path: stands here twice, first on line 2"));
  EXPECT_GE(twice.faults.size(), 5u);  // path, foo, bar, left, right
}

TEST(Settings, PathsAreRelativeToTheFile) {
  EXPECT_EQ(changed("path: \"\"", "path: ../map").settings.map.path, "map");
  EXPECT_EQ(changed("path: \"\"", "path: /srv/map").settings.map.path, "/srv/map");
  EXPECT_EQ(changed("path: \"\"", "path: here").settings.map.path, "dir/here");
}

TEST(Settings, ReadsSizesPayloadsPinsAndModels) {
  const Settings memory = changed("payload: [features, scan, grid, blocks]",
                                  "payload: [features, image]\n  budget: 24MiB")
                              .settings;
  EXPECT_EQ(memory.memory.budget, 24 * kMiB);
  EXPECT_EQ(memory.memory.payload.mask,
            kCoreOnly | mask_of(fb::PayloadKind::Features) | mask_of(fb::PayloadKind::Image));
  EXPECT_THAT(changed("pinned: []", "pinned: [L1, H1]").settings.memory.pinned,
              ElementsAre("L1", "H1"));
  const LoadedSettings twist = changed("model: differential-positions", "model: twist");
  EXPECT_THAT(twist.faults, IsEmpty());
  EXPECT_EQ(twist.settings.odometry.wheels.signals[0].id, 0x221u);
  EXPECT_EQ(twist.settings.odometry.wheels.signals[1].bits.start, 23);
  // One turn of a wheel of radius 0.14 m: 2 pi 0.14 m.
  EXPECT_DOUBLE_EQ(
      changed("unit: metres", "unit: turns").settings.odometry.wheels.metres_per_unit[0],
      2 * 3.14159265358979323846 * 0.14);
  EXPECT_EQ(changed("unit: metres", "unit: radians").settings.odometry.wheels.metres_per_unit[0],
            0.14);
}

TEST(Settings, ReadsAMultiplexedExtendedFloat) {
  const LoadedSettings loaded = changed(
      "    turn_rate:\n",
      "    temperature: {id: 0x18FF1234, extended: true, start: 8, length: 32, type: float,\n"
      "                  multiplexer: {start: 0, length: 8, value: 5}}\n    turn_rate:\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  const CanSignal& signal = loaded.settings.can.signals.at("temperature");
  EXPECT_TRUE(signal.extended);
  EXPECT_EQ(signal.type, SignalType::kFloat);
  EXPECT_EQ(signal.levels, 1);
  EXPECT_EQ(signal.multiplexers[0],
            (CanSignal::Multiplexer{{0, 8, ByteOrder::kLittle}, {CanSignal::Values{5, 5}}, 1}));
}

TEST(Settings, WhatIsNotAYamlMappingIsAFaultNotACrash) {
  for (const char* text :
       {"", "just text", "- a\n- b", "a: b: c", "map: [1, 2", "\t- x", "? [a]: b", "map: 3",
        "can: {signals: 5}", "can: {signals: {a: 5}}", "---\na: 1\n---\nb: 2", "x: *unknown",
        "\"\\xZZ\"", "can: {signals: {a: {multiplexer: 3}}}"}) {
    const LoadedSettings loaded = parse_settings(text, "a.yaml");
    EXPECT_FALSE(loaded.ok()) << text;
    for (const std::string& fault : loaded.faults)
      EXPECT_THAT(fault, testing::StartsWith("a.yaml"));
  }
  EXPECT_THAT(load_settings("/no/such/file.yaml").faults,
              ElementsAre(HasSubstr("/no/such/file.yaml: cannot be read: No such file")));
  EXPECT_FALSE(load_settings(testing::TempDir()).ok());
}

TEST(Settings, AFileThatStandsInForAnotherIsCalledWhatItIs) {
  const std::string path = testing::TempDir() + "stand_in_" + std::to_string(::getpid());
  const auto write = [&](const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  };
  write("version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  EXPECT_THAT(load_settings(path).faults, ElementsAre(AllOf(HasSubstr("is a Git LFS pointer"),
                                                            HasSubstr("a settings file (YAML)"))));
  EXPECT_THAT(load_dbc(path).faults,
              ElementsAre(AllOf(HasSubstr("is a Git LFS pointer"), HasSubstr("a DBC file"))));
  write("\x1F\x8B\x08");
  EXPECT_THAT(load_settings(path).faults, ElementsAre(HasSubstr("is compressed by gzip")));
  EXPECT_THAT(load_dbc(path).faults, ElementsAre(HasSubstr("is compressed by gzip")));
  ::unlink(path.c_str());
}

// 90,000 keys took minutes when each was compared with all before it.
TEST(Settings, WithTooManyKeysAreRefusedWhereTheLimitIsReached) {
  std::string text = "map:\n";
  for (int i = 0; i < 90'000; ++i) text += "  k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(parse_settings(text, "a.yaml").faults,
              ElementsAre(HasSubstr("at most 20000 keys and values are allowed")));
}

TEST(Settings, WithManyUnknownKeysAreRefusedInFewWords) {
  std::string text = "map:\n";
  for (int i = 0; i < 9'000; ++i) text += "  k" + std::to_string(i) + ": 1\n";
  const std::vector<std::string> faults = parse_settings(text, "a.yaml").faults;
  ASSERT_EQ(faults.size(), 201u);
  EXPECT_THAT(faults[0], HasSubstr("a.yaml:2: map.k0: unknown key"));
  EXPECT_THAT(faults[200], testing::StartsWith("a.yaml: and "));
}

}  // namespace
}  // namespace zonepack
