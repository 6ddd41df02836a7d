// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_script.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "platform/can/can_log_line.hpp"
#include "runtime/live/bus/script_source.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::string fault_of(const std::string& text) {
  const LoadedCanScript loaded = parse_can_script(text, "bus.yaml");
  return loaded.faults.empty() ? "" : loaded.faults.front();
}

TEST(CanScript, ReadsWhatThePageSays) {
  const LoadedCanScript loaded = parse_can_script(
      "drive: {period: 0.01, legs: [{for: 2, speed: 0.5}, {for: 1, yaw_rate: 0.3}]}\n"
      "loops: 3\nbit_rate: 500000\nqueue: 256\n"
      "traffic: [{id: 0x0A0, period: 0.001}]\n"
      "faults:\n  - {at: 20, for: 0.5, kind: bus_off}\n  - {at: 30, count: 100, kind: overflow}\n",
      "bus.yaml");
  ASSERT_TRUE(loaded.faults.empty()) << loaded.faults.front();
  const CanScript& script = loaded.script;
  EXPECT_EQ(script.drive.legs.size(), 2u);
  EXPECT_EQ(script.drive.loops, 3u);
  EXPECT_EQ(script.wire.bit_rate, 500'000u);
  EXPECT_EQ(script.queue, 256u);
  EXPECT_EQ(script.traffic.at(0).id, 0xA0u);
  ASSERT_EQ(script.wire.faults.size(), 2u);
  EXPECT_EQ(script.wire.faults[0].kind, SimFault::Kind::kBusOff);
  EXPECT_EQ(script.wire.faults[0].for_ns, 500 * kMs);
  EXPECT_EQ(script.wire.faults[1].count, 100u);
}

TEST(CanScript, FindsTheLogBesideItself) {
  EXPECT_EQ(parse_can_script("log: a.log", "folder/bus.yaml").script.log, "folder/a.log");
}

TEST(CanScript, RefusesWhatItDoesNotUnderstandByLineAndKey) {
  EXPECT_EQ(fault_of("log: a.log\nbitrate: 5\n").find("bus.yaml:2: bitrate: "), 0u);
  EXPECT_NE(fault_of("log: a\nfaults: [{at: 1, for: 1, kind: busoff}]").find("bus_off"),
            std::string::npos);
  EXPECT_NE(fault_of("log: a\nfaults: [{at: 1, kind: bus_off}]").find("for (s)"),
            std::string::npos);
  EXPECT_NE(fault_of("log: a\nfaults: [{at: 1, kind: drop, for: 1, count: 1}]").find("either"),
            std::string::npos);
  EXPECT_NE(fault_of("bit_rate: 5").find("either log"), std::string::npos);
  EXPECT_NE(fault_of("log: a\ntraffic: [{id: 0x800}]").find("extended"), std::string::npos);
  EXPECT_NE(fault_of("drive: {legs: []}").find("at least one leg"), std::string::npos);
  EXPECT_NE(fault_of("log: [").find("not YAML"), std::string::npos);
  EXPECT_NE(load_can_script("/nowhere/bus.yaml").faults.at(0).find("/nowhere/bus.yaml"),
            std::string::npos);
}

TEST(RepeatedLog, GoesOnAfterItsEnd) {
  test_support::TemporaryFolder folder;
  const std::string path = folder / "a.log";
  std::ofstream(path) << "(10.000000) can0 001#\n(10.100000) can0 002#\n";
  RepeatedLog log(path, "can0", 3);
  ASSERT_TRUE(log.open());
  std::vector<std::int64_t> stamps;
  while (const auto frame = log.next()) stamps.push_back(frame->stamp_ns / kMs);
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{10'000, 10'100, 10'120, 10'220, 10'240, 10'340}));
}

TEST(ScriptedBus, HearsTheDriveAndTheTrafficUntilTheDriveEnds) {
  CanScript script = parse_can_script(
                         "drive: {legs: [{for: 0.1, speed: 1}]}\n"
                         "traffic: [{id: 1, period: 0.01}]",
                         "bus.yaml")
                         .script;
  WheelOdometrySettings odometry;
  odometry.signals[0].id = odometry.signals[1].id = 0x311;
  odometry.signals[0].bits = {0, 32, ByteOrder::kLittle};
  odometry.signals[1].bits = {32, 32, ByteOrder::kLittle};
  const auto bus = ScriptedBus::make(script, "can0", odometry);
  ASSERT_TRUE(bus) << bus.error().message;
  std::size_t drive = 0, traffic = 0;
  while (const auto frame = (*bus)->wire().next()) ++(frame->id == 1 ? traffic : drive);
  EXPECT_EQ(drive, 5u);    // 0, 20 ... 80 ms
  EXPECT_EQ(traffic, 9u);  // 0, 10 ... 80 ms
}

TEST(ScriptedBus, SaysWhichModelsItCannotDrive) {
  WheelOdometrySettings odometry;
  odometry.model = OdometryModel::kMecanumSpeeds;
  const auto refused = ScriptedBus::make(
      parse_can_script("drive: {legs: [{for: 1}]}", "bus.yaml").script, "", odometry);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("twist"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
