// SPDX-License-Identifier: Apache-2.0
// Time per decoded signal and per frame of odometry: signal_bench (Google Benchmark's options).
#include <benchmark/benchmark.h>

#include <array>

#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {
namespace {

CanSignal signal(std::uint16_t start, std::uint16_t length, ByteOrder order, SignalType type) {
  CanSignal made;
  made.id = 0x311;
  made.bits = {start, length, order};
  made.type = type;
  made.factor = 0.001;
  return made;
}

// Frames whose positions go on, so that nothing is refused.
std::array<CanFrame, 1024> frames() {
  std::array<CanFrame, 1024> made;
  for (std::size_t i = 0; i < made.size(); ++i) {
    CanFrame& frame = made[i];
    frame.id = 0x311;
    frame.len = 8;
    frame.stamp_ns = static_cast<std::int64_t>(i) * 1'000'000;
    frame.data[2] = frame.data[6] = static_cast<std::uint8_t>(i >> 8);
    frame.data[3] = frame.data[7] = static_cast<std::uint8_t>(i);
  }
  return made;
}

void read(benchmark::State& state, const CanSignal& wanted) {
  const auto made = frames();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(read_signal(wanted, made[i++ % made.size()]));
  }
  state.SetItemsProcessed(state.iterations());
}

void big_int32(benchmark::State& state) {
  read(state, signal(7, 32, ByteOrder::kBig, SignalType::kSigned));
}
void little_int16(benchmark::State& state) {
  read(state, signal(16, 16, ByteOrder::kLittle, SignalType::kSigned));
}
void little_odd_41_bits(benchmark::State& state) {
  read(state, signal(5, 41, ByteOrder::kLittle, SignalType::kUnsigned));
}
void little_float(benchmark::State& state) {
  read(state, signal(0, 32, ByteOrder::kLittle, SignalType::kFloat));
}
void multiplexed(benchmark::State& state) {
  CanSignal wanted = signal(16, 16, ByteOrder::kLittle, SignalType::kSigned);
  add_multiplexer(wanted, {0, 8, ByteOrder::kLittle}, {0, 0});
  read(state, wanted);
}
void of_another_id(benchmark::State& state) {
  CanSignal wanted = signal(7, 32, ByteOrder::kBig, SignalType::kSigned);
  wanted.id = 0x221;
  read(state, wanted);
}

// A frame with both wheels, to an increment.
void odometry_frame(benchmark::State& state) {
  WheelOdometrySettings settings;
  settings.signals[0] = signal(7, 32, ByteOrder::kBig, SignalType::kSigned);
  settings.signals[1] = signal(39, 32, ByteOrder::kBig, SignalType::kSigned);
  WheelOdometry odometry(settings);
  auto made = frames();
  std::size_t i = 0;
  std::int64_t stamp_ns = 0;
  for (auto _ : state) {
    CanFrame& frame = made[i++ % made.size()];
    frame.stamp_ns = stamp_ns += 1'000'000;
    benchmark::DoNotOptimize(odometry.take(frame));
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(big_int32);
BENCHMARK(little_int16);
BENCHMARK(little_odd_41_bits);
BENCHMARK(little_float);
BENCHMARK(multiplexed);
BENCHMARK(of_another_id);
BENCHMARK(odometry_frame);

}  // namespace
}  // namespace zonepack

BENCHMARK_MAIN();
