// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_wire.hpp"

#include <gtest/gtest.h>

#include <array>

#include "platform/can/can_errors.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kUs = 1000, kWireMs = 1'000'000;

class List final : public CanFrameSource {
 public:
  List(std::initializer_list<CanFrame> frames) : frames_(frames) {}
  // Ten 1 ms apart.
  static List ten(std::uint32_t id) {
    List list{};
    for (int i = 0; i < 10; ++i) {
      CanFrame wire_frame;
      wire_frame.id = id;
      wire_frame.stamp_ns = i * kWireMs;
      list.frames_.push_back(wire_frame);
    }
    return list;
  }
  std::optional<CanFrame> next() noexcept override {
    if (given_ == frames_.size()) return std::nullopt;
    return frames_[given_++];
  }

 private:
  std::vector<CanFrame> frames_;
  std::size_t given_ = 0;
};

CanFrame wire_frame(std::uint32_t id, std::int64_t stamp_ns, std::uint8_t len = 0,
                    bool extended = false) {
  CanFrame made;
  made.id = id;
  made.stamp_ns = stamp_ns;
  made.len = len;
  made.extended = extended;
  return made;
}

std::vector<CanFrame> all(SimWire& wire) {
  std::vector<CanFrame> frames;
  while (const auto next = wire.next()) frames.push_back(*next);
  return frames;
}

std::vector<CanFrame> heard(SimFault fault, std::uint64_t* dropped = nullptr) {
  List node = List::ten(1);
  SimWire wire({.faults = {fault}}, {&node});
  auto frames = all(wire);
  if (dropped != nullptr) *dropped = wire.dropped();
  return frames;
}

TEST(SimWire, TakesTheTimeOfTheBits) {
  List node{wire_frame(1, 0, 8), wire_frame(2, 10 * kWireMs, 8, true)};
  SimWire wire({.bit_rate = 500'000}, {&node});
  const auto frames = all(wire);
  EXPECT_EQ(frames[0].stamp_ns, 270 * kUs);                 // 135 bits of 2 us
  EXPECT_EQ(frames[1].stamp_ns, 10 * kWireMs + 320 * kUs);  // 160 bits
}

TEST(SimWire, GivesTheWireToTheLowestIdOfThoseThatAreReady) {
  List fast{wire_frame(0x300, 20 * kUs), wire_frame(0x200, 30 * kUs)};
  List slow{wire_frame(0x100, 0), wire_frame(0x700, 10 * kUs)};
  // 110 us each: 0x100 goes alone, then 0x300 before 0x700; 0x200 is behind 0x300 in its node.
  SimWire wire({.bit_rate = 500'000}, {&slow, &fast});
  const auto frames = all(wire);
  ASSERT_EQ(frames.size(), 4u);
  const std::array<std::uint32_t, 4> order{0x100, 0x300, 0x200, 0x700};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].id, order[i]);
    EXPECT_EQ(frames[i].stamp_ns, static_cast<std::int64_t>(i + 1) * 110 * kUs);
  }
  EXPECT_EQ(wire.waited(), 3u);
}

TEST(SimWire, EndsWithTheFirstOfItsNodes) {
  List first{wire_frame(1, 0)};
  List endless = List::ten(2);
  SimWire wire({.bit_rate = 500'000}, {&first, &endless});
  EXPECT_EQ(all(wire).size(), 1u);
}

TEST(SimWire, LetsAStandardIdWinOverAnExtendedOneThatBeginsAlike) {
  List standard{wire_frame(0x123, 0)};
  List extended{wire_frame(0x123u << 18u, 0, 0, true)};
  SimWire wire({.bit_rate = 500'000}, {&extended, &standard});
  EXPECT_FALSE(wire.next()->extended);
}

TEST(SimWire, SendsTheDataOfFdFramesAtTheirOwnRate) {
  CanFrame fd = wire_frame(1, 0, 64);
  fd.fd = true;
  fd.flags = 1;
  List node{fd};
  SimWire wire({.bit_rate = 500'000, .data_bit_rate = 2'000'000}, {&node});
  // 35 bits of 2 us, then (5 + 512) * 5/4 + 31 = 677 bits of 0.5 us.
  EXPECT_EQ(wire.next()->stamp_ns, 70 * kUs + 338'500);
}

TEST(SimWire, LosesFramesUnnoticedOrCounted) {
  std::uint64_t dropped = 0;
  EXPECT_EQ(
      heard({.kind = SimFault::Kind::kDrop, .at_ns = 3 * kWireMs, .count = 2}, &dropped).size(),
      8u);
  EXPECT_EQ(dropped, 0u);
  EXPECT_EQ(
      heard({.kind = SimFault::Kind::kDrop, .at_ns = 3 * kWireMs, .for_ns = 5 * kWireMs}).size(),
      5u);
  const auto rest =
      heard({.kind = SimFault::Kind::kOverflow, .at_ns = 3 * kWireMs, .count = 4}, &dropped);
  EXPECT_EQ(rest.size(), 6u);
  EXPECT_EQ(rest[3].stamp_ns, 7 * kWireMs);
  EXPECT_EQ(dropped, 4u);
}

TEST(SimWire, IsSilentWhileOurControllerIsOffTheBusAndSaysSo) {
  const auto frames =
      heard({.kind = SimFault::Kind::kBusOff, .at_ns = 3 * kWireMs, .for_ns = 4 * kWireMs});
  // 0, 1, 2 ms; bus-off; restarted at 7 ms; 7, 8, 9 ms.
  ASSERT_EQ(frames.size(), 8u);
  CanBusStatus status;
  take_error_frame(frames[3], status);
  EXPECT_EQ(status.state, CanBusState::kOff);
  take_error_frame(frames[4], status);
  EXPECT_EQ(status.state, CanBusState::kActive);
  EXPECT_EQ(frames[4].stamp_ns, 7 * kWireMs);
  EXPECT_EQ(frames[5].stamp_ns, 7 * kWireMs);
}

TEST(SimWire, ReportsAPassiveControllerWhileFramesArrive) {
  const auto frames =
      heard({.kind = SimFault::Kind::kPassive, .at_ns = 3 * kWireMs, .for_ns = 4 * kWireMs});
  EXPECT_EQ(frames.size(), 12u);
  EXPECT_TRUE(frames[3].error);
}

TEST(SimWire, HoldsFramesBackAndDeliversThemAtOnce) {
  const auto frames =
      heard({.kind = SimFault::Kind::kDelay, .at_ns = 3 * kWireMs, .for_ns = 4 * kWireMs});
  ASSERT_EQ(frames.size(), 10u);
  for (std::size_t i = 3; i <= 7; ++i) EXPECT_EQ(frames[i].stamp_ns, 7 * kWireMs);
}

TEST(SimWire, SendsAFrameAgainThatNoiseDestroyed) {
  List node{wire_frame(1, 0)};
  SimWire wire(
      {.bit_rate = 500'000, .faults = {{.kind = SimFault::Kind::kNoise, .for_ns = kWireMs}}},
      {&node});
  EXPECT_EQ(wire.next()->stamp_ns, (55 + 31 + 55) * 2 * kUs);
}

TEST(SimWire, TakesTheInterfaceOfABusDown) {
  List node = List::ten(1);
  SimWire wire(
      {.faults = {{.kind = SimFault::Kind::kAbsent, .at_ns = 7 * kWireMs, .for_ns = kWireMs},
                  {.kind = SimFault::Kind::kDown, .at_ns = 2 * kWireMs, .for_ns = 3 * kWireMs}}},
      {&node});
  SimCanBus bus(&wire);
  bus.plan(wire.links());
  std::array<CanFrame, 16> into;
  std::size_t frames = 0;
  const auto at = [&](std::int64_t now_ns) {
    bus.advance_to(now_ns);
    frames += bus.receive(into);
    return bus.status().link;
  };
  EXPECT_EQ(at(kWireMs), CanLink::kUp);
  EXPECT_EQ(at(2 * kWireMs), CanLink::kDown);
  EXPECT_EQ(at(5 * kWireMs), CanLink::kUp);
  EXPECT_EQ(at(7 * kWireMs), CanLink::kAbsent);
  EXPECT_EQ(at(9 * kWireMs), CanLink::kUp);
  EXPECT_EQ(frames, 6u);  // 0, 1; 5, 6; 8, 9 ms
  EXPECT_EQ(bus.status().reconnects, 1u);
}

}  // namespace
}  // namespace zonepack
