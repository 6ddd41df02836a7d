// SPDX-License-Identifier: Apache-2.0
// The ready-made robots of config/: a candump log, built byte by byte as the vendor's manual
// describes and read with the robot's settings, ends where the drive it was made from ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "platform/can/can_log.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

using testing::IsEmpty;

// A drive of 40 s: left and right distances in metres, and where it leads.
struct Wheels {
  double left_m = 0;
  double right_m = 0;
};
Wheels speeds_at(double t_s) {
  const double ramp = t_s < 1 ? t_s : 1;
  return {ramp * (0.6 + 0.2 * std::sin(0.9 * t_s)), ramp * (0.6 - 0.25 * std::sin(0.5 * t_s))};
}

// A log as candump -l writes it.
class Log {
 public:
  explicit Log(const std::string& name) : path_(testing::TempDir() + name), file_(path_) {}
  void frame(double t_s, std::uint32_t id, const std::vector<std::uint8_t>& data, bool extended) {
    char text[64];
    std::snprintf(text, sizeof text, "(%.6f) can0 %0*X#", 1.7e9 + t_s, extended ? 8 : 3, id);
    file_ << text;
    for (const std::uint8_t byte : data) {
      std::snprintf(text, sizeof text, "%02X", byte);
      file_ << text;
    }
    file_ << '\n';
  }
  const std::string& close() {
    file_.close();
    return path_;
  }

 private:
  std::string path_;
  std::ofstream file_;
};

using Bytes = std::vector<std::uint8_t>;

void put_little(Bytes& data, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) data.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void put_big(Bytes& data, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) data.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
std::uint64_t counts(double value) { return static_cast<std::uint64_t>(std::llround(value)); }
std::uint64_t float_bits(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

// Writes the frames of one moment: distances so far and present speeds.
using Write = std::function<void(Log&, double t_s, const Wheels& ways, const Wheels& speeds)>;

struct DriveEnd {
  Pose2 pose, truth;
  WheelOdometryCounters counters;
  double timeout_s = 0;
  double error_m() const { return std::hypot(pose.x_m - truth.x_m, pose.y_m - truth.y_m); }
};

DriveEnd drive(const LoadedSettings& loaded, const std::string& name, double period_s,
               const Write& write) {
  EXPECT_THAT(loaded.faults, IsEmpty());
  DriveEnd outcome;
  const WheelOdometrySettings& settings = loaded.settings.odometry.wheels;
  outcome.timeout_s = settings.timeout_s;
  Log made(name + ".log");
  Wheels ways;
  const int fine = 20;
  for (int i = 0; i * period_s <= 40; ++i) {
    for (int k = 0; i > 0 && k < fine; ++k) {
      const double s = period_s / fine;
      const Wheels v = speeds_at((i - 1) * period_s + (k + 0.5) * s);
      ways.left_m += v.left_m * s;
      ways.right_m += v.right_m * s;
      outcome.truth =
          compose(outcome.truth, along_arc((v.left_m + v.right_m) / 2 * s,
                                           (v.right_m - v.left_m) / settings.geometry.track_m * s));
    }
    write(made, i * period_s, ways, speeds_at(i * period_s));
  }
  CanLogReader log(made.close(), loaded.settings.can.interface);
  EXPECT_TRUE(log.open().ok());
  WheelOdometry odometry(settings);
  while (const auto frame = log.next()) {
    if (const auto step = odometry.take(*frame)) {
      outcome.pose = compose(outcome.pose, step->motion.pose);
    }
  }
  outcome.counters = odometry.counters();
  std::remove(made.close().c_str());
  return outcome;
}

LoadedSettings profile(const std::string& name) {
  return load_settings(ZONEPACK_SOURCE_DIR "/config/" + name + ".yaml");
}

// The same with some keys of the section odometry replaced: "key: value" lines.
LoadedSettings profile_with(const std::string& name,
                            std::vector<std::pair<std::string, std::string>> changes) {
  const std::string path = ZONEPACK_SOURCE_DIR "/config/" + name + ".yaml";
  std::ifstream file(path);
  std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return parse_settings(text, path);
}

void expect_arrival(const DriveEnd& outcome, double most_m) {
  EXPECT_GT(std::hypot(outcome.truth.x_m, outcome.truth.y_m), 2);
  EXPECT_LT(outcome.error_m(), most_m);
  EXPECT_LT(std::abs(wrap_angle(outcome.pose.yaw_rad - outcome.truth.yaw_rad)), most_m);
  EXPECT_EQ(outcome.counters.rejected, 0u);
  EXPECT_EQ(outcome.counters.rebased, 0u);
}

TEST(Profiles, AgileXOdometersAndTwist) {
  const Write write = [](Log& log, double t, const Wheels& ways, const Wheels& v) {
    Bytes twist, odometers;
    put_big(twist, counts((v.left_m + v.right_m) / 2 * 1000), 2);
    put_big(twist, counts((v.right_m - v.left_m) / 0.413 * 1000), 2);
    put_big(twist, 0, 4);
    put_big(odometers, counts(ways.left_m * 1000 - 2147480000.0), 4);
    put_big(odometers, counts(ways.right_m * 1000 + 2147480000.0), 4);  // wraps on the way
    log.frame(t, 0x221, twist, false);
    log.frame(t + 0.0002, 0x311, odometers, false);
  };
  expect_arrival(drive(profile("agilex"), "agilex", 0.02, write), 0.01);
  expect_arrival(drive(profile_with("agilex", {{"model: differential-positions", "model: twist"}}),
                       "agilex_twist", 0.02, write),
                 0.05);
}

TEST(Profiles, ODrivePositionsAndSpeeds) {
  const Write write = [](Log& log, double t, const Wheels& ways, const Wheels& v) {
    const double turn_m = 2 * kPi * 0.0825;
    for (const std::uint32_t node : {0u, 1u}) {
      const double sign = node == 0 ? 1 : -1;
      Bytes encoder;
      put_little(encoder, float_bits(sign * (node == 0 ? ways.left_m : ways.right_m) / turn_m), 4);
      put_little(encoder, float_bits(sign * (node == 0 ? v.left_m : v.right_m) / turn_m), 4);
      log.frame(t + 0.0003 * node, node * 32 + 9, encoder, false);
    }
  };
  const DriveEnd positions = drive(profile("odrive"), "odrive", 0.01, write);
  expect_arrival(positions, 0.005);
  EXPECT_DOUBLE_EQ(positions.timeout_s, 0.03);
  expect_arrival(
      drive(profile_with("odrive", {{"model: differential-positions", "model: wheel-speeds"},
                                    {"LeftEncoder.Position", "LeftEncoder.Velocity"},
                                    {"RightEncoder.Position", "RightEncoder.Velocity"}}),
            "odrive_speeds", 0.01, write),
      0.02);
}

TEST(Profiles, VescTachometersAndErpm) {
  const Write write = [](Log& log, double t, const Wheels& ways, const Wheels& v) {
    const double turn_m = 2 * kPi * 0.0825;
    for (const std::uint32_t id : {1u, 2u}) {
      Bytes status, status5;
      put_big(status, counts((id == 1 ? v.left_m : v.right_m) / turn_m * 60 * 15), 4);
      put_big(status, 123, 2);
      put_big(status, 456, 2);
      put_big(status5, counts((id == 1 ? ways.left_m : ways.right_m) / turn_m * 90 + 2147483000.0),
              4);
      put_big(status5, 240, 2);
      put_big(status5, 0, 2);
      log.frame(t + 0.0003 * id, 9 << 8 | id, status, true);
      log.frame(t + 0.0003 * id + 0.0001, 27 << 8 | id, status5, true);
    }
  };
  // A step is 5.8 mm.
  const DriveEnd positions = drive(profile("vesc"), "vesc", 0.02, write);
  expect_arrival(positions, 0.05);
  EXPECT_DOUBLE_EQ(positions.timeout_s, 0.06);
  expect_arrival(
      drive(profile_with("vesc", {{"model: differential-positions", "model: wheel-speeds"},
                                  {"LeftStatus5.Tachometer", "LeftStatus.Erpm"},
                                  {"RightStatus5.Tachometer", "RightStatus.Erpm"},
                                  {"unit: ticks", "unit: erpm"},
                                  {"ticks_per_turn: 90", "pole_pairs: 15"}}),
            "vesc_erpm", 0.02, write),
      0.03);
}

// SYNC, then both drives' TPDO1; heartbeats every 100 ms while `alive`.
Write canopen_frames(const std::function<bool(double)>& alive) {
  return [alive](Log& log, double t, const Wheels& ways, const Wheels&) {
    const double ticks_per_m = 4000 * 20 / (2 * kPi * 0.10);
    if (std::lround(t * 1000) % 100 == 0) {
      log.frame(t, 0x701, {5}, false);
      if (alive(t)) log.frame(t, 0x702, {5}, false);
    }
    log.frame(t, 0x80, {}, false);
    for (const std::uint32_t node : {1u, 2u}) {
      Bytes pdo;
      put_little(pdo, 0x0637, 2);  // operation enabled
      put_little(pdo, counts((node == 1 ? ways.left_m : -ways.right_m) * ticks_per_m), 4);
      log.frame(t + 0.0005 * node, 0x180 + node, pdo, false);
    }
  };
}

TEST(Profiles, CanOpen402PositionsOnSync) {
  const DriveEnd outcome =
      drive(profile("canopen_402"), "canopen", 0.02, canopen_frames([](double) { return true; }));
  expect_arrival(outcome, 0.005);
  EXPECT_EQ(outcome.counters.unwatched, 0u);
}

TEST(Profiles, CanOpen402DataIsRefusedWhileAHeartbeatIsMissing) {
  const DriveEnd outcome = drive(profile("canopen_402"), "canopen_lost", 0.02,
                                 canopen_frames([](double t) { return t < 10 || t >= 12; }));
  // The last heartbeat came at 9.9 s; from 10.2 s to 12 s nothing was believed: 2 * 90 frames.
  EXPECT_NEAR(static_cast<double>(outcome.counters.unwatched), 180, 4);
  EXPECT_EQ(outcome.counters.gaps, 1u);
  // Positions still know the distance; only its curve is lost.
  EXPECT_LT(outcome.error_m(), 0.15);
  EXPECT_LT(std::abs(wrap_angle(outcome.pose.yaw_rad - outcome.truth.yaw_rad)), 0.005);
}

TEST(Profiles, RoboteqCountersInUserVariables) {
  const Write write = [](Log& log, double t, const Wheels& ways, const Wheels&) {
    const double ticks_per_m = 4096 * 15 / (2 * kPi * 0.11);
    if (std::lround(t * 1000) % 1000 == 0) log.frame(t, 0x701, {5}, false);
    Bytes tpdo1;
    put_little(tpdo1, counts(ways.left_m * ticks_per_m), 4);
    put_little(tpdo1, counts(ways.right_m * ticks_per_m), 4);
    log.frame(t + 0.001, 0x181, tpdo1, false);
  };
  const DriveEnd outcome = drive(profile("roboteq"), "roboteq", 0.02, write);
  expect_arrival(outcome, 0.005);
  EXPECT_DOUBLE_EQ(outcome.timeout_s, 0.06);
}

}  // namespace
}  // namespace zonepack
