// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/generated_drive.hpp"

#include <gtest/gtest.h>

#include "runtime/odometry/can_signals.hpp"

namespace zonepack {
namespace {

CanSignal signal_of(std::uint32_t id, SignalBits bits, SignalType type = SignalType::kUnsigned) {
  CanSignal signal;
  signal.id = id;
  signal.bits = bits;
  signal.type = type;
  return signal;
}

// Two int32 of millimetres, Motorola, as AgileX sends them.
WheelOdometrySettings agilex() {
  WheelOdometrySettings odometry;
  CanSignal signal = signal_of(0x311, {}, SignalType::kSigned);
  signal.factor = 0.001;
  odometry.signals = {signal, signal, {}, {}};
  odometry.signals[0].bits = {7, 32, ByteOrder::kBig};
  odometry.signals[1].bits = {39, 32, ByteOrder::kBig};
  odometry.geometry.track_m = 0.4;
  return odometry;
}

TEST(WriteSignal, IsWhatReadSignalReads) {
  CanFrame frame;
  frame.id = 5;
  const auto round_trip = [&frame](SignalBits bits, SignalType type, double value) {
    CanSignal signal = signal_of(5, bits, type);
    signal.factor = 0.5;
    signal.offset = 1;
    write_signal(signal, value, frame);
    return read_signal(signal, frame).value;
  };
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
    EXPECT_EQ(round_trip({11, 13, order}, SignalType::kSigned, -100), -100);
    EXPECT_EQ(round_trip({7, 16, order}, SignalType::kUnsigned, 20'000), 20'000);
    EXPECT_EQ(round_trip({7, 32, order}, SignalType::kFloat, 0.75), 0.75);
  }
  EXPECT_EQ(round_trip({0, 64, ByteOrder::kLittle}, SignalType::kDouble, -2.125), -2.125);
  EXPECT_EQ(round_trip({0, 8, ByteOrder::kLittle}, SignalType::kUnsigned, 129), 1);  // 256 wraps
}

TEST(WriteSignal, SelectsAMultiplexedSignal) {
  CanSignal signal = signal_of(5, {8, 8, ByteOrder::kLittle});
  ASSERT_TRUE(add_multiplexer(signal, {0, 8, ByteOrder::kLittle}, {3, 4}));
  CanFrame frame;
  frame.id = 5;
  write_signal(signal, 77, frame);
  EXPECT_EQ(frame.data[0], 3);
  EXPECT_EQ(read_signal(signal, frame).value, 77);
}

TEST(GeneratedDrive, IsDrivenByOdometryAsItWasMeant) {
  const WheelOdometrySettings settings = agilex();
  // 2 s at 0.5 m/s, then on the spot by 1 rad; twice.
  GeneratedDrive drive({.period_s = 0.02, .legs = {{2, 0.5, 0}, {2, 0, 0.5}}, .loops = 2},
                       settings);
  WheelOdometry odometry(settings);
  double forward_m = 0, turned_rad = 0;
  std::int64_t last_ns = 0;
  std::size_t frames = 0;
  while (const auto frame = drive.next()) {
    ++frames;
    last_ns = frame->stamp_ns;
    if (const auto step = odometry.take(*frame)) {
      const double seconds = static_cast<double>(step->to_ns - step->from_ns) * 1e-9;
      forward_m += step->speed_m_s * seconds;
      turned_rad += step->yaw_rate_rad_s * seconds;
    }
  }
  EXPECT_EQ(frames, 400u);
  EXPECT_EQ(last_ns, 7'980'000'000);
  // What a leg lacks while it speeds up it gains while it slows down, in the next one. The last one
  // lacks half of 0.1 s of speeding up, and the last sample, at 7.98 s, 0.02 s: 0.025 + 0.01 rad.
  EXPECT_NEAR(forward_m, 2.0, 0.005);
  EXPECT_NEAR(turned_rad, 2 - 0.035, 0.01);
  EXPECT_EQ(odometry.counters().rejected, 0u);
}

TEST(GeneratedDrive, SendsHeartbeatsThatAreWatched) {
  WheelOdometrySettings settings = agilex();
  settings.canopen.nodes = {3};
  settings.canopen.node_count = 1;
  settings.canopen.sync_timeout_s = 0.1;
  GeneratedDrive drive({.period_s = 0.02, .legs = {{1, 0.5, 0}}, .loops = 1}, settings);
  WheelOdometry odometry(settings);
  std::size_t steps = 0;
  while (const auto frame = drive.next()) steps += odometry.take(*frame).has_value();
  EXPECT_EQ(steps, 49u);
  EXPECT_EQ(odometry.counters().unwatched, 0u);
}

TEST(PeriodicFrames, NeverEnd) {
  CanFrame first;
  first.stamp_ns = 5;
  PeriodicFrames frames(first, 10);
  EXPECT_EQ(frames.next()->stamp_ns, 5);
  EXPECT_EQ(frames.next()->stamp_ns, 15);
}

}  // namespace
}  // namespace zonepack
