// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_can_bus.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace zonepack {
namespace {

CanFrame frame(std::uint32_t id, std::int64_t stamp_ns) {
  CanFrame made;
  made.id = id;
  made.stamp_ns = stamp_ns;
  return made;
}

std::vector<std::uint32_t> receive(CanBus& bus, std::size_t most = 8) {
  std::array<CanFrame, 8> into;
  const std::size_t count = bus.receive({into.data(), most});
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < count; ++i) ids.push_back(into[i].id);
  return ids;
}

using Ids = std::vector<std::uint32_t>;

TEST(SimCanBus, DeliversAFrameWhenItsStampHasCome) {
  SimCanBus bus;
  bus.push(frame(1, 10));
  bus.push(frame(2, 20));
  EXPECT_EQ(receive(bus), Ids{});
  EXPECT_EQ(bus.next_arrival_ns(), 10);
  bus.advance_to(10);
  EXPECT_EQ(receive(bus), Ids{1});
  bus.advance_to(5);  // time does not run back
  bus.advance_to(25);
  EXPECT_EQ(receive(bus), Ids{2});
  EXPECT_EQ(bus.next_arrival_ns(), std::nullopt);
}

TEST(SimCanBus, HoldsBackWhatDoesNotFitTheBatch) {
  SimCanBus bus;
  for (std::uint32_t id = 1; id <= 5; ++id) bus.push(frame(id, 10));
  bus.advance_to(10);
  EXPECT_EQ(receive(bus, 2), (Ids{1, 2}));
  EXPECT_EQ(receive(bus, 0), Ids{});
  EXPECT_EQ(receive(bus, 2), (Ids{3, 4}));
  EXPECT_EQ(receive(bus, 2), Ids{5});
}

TEST(SimCanBus, AFrameWithAnEarlierStampArrivesWithItsPredecessor) {
  SimCanBus bus;
  for (const CanFrame& f : {frame(1, 10), frame(2, 30), frame(3, 20), frame(4, 31)}) bus.push(f);
  bus.advance_to(29);
  EXPECT_EQ(receive(bus), Ids{1});
  bus.advance_to(30);
  EXPECT_EQ(receive(bus), (Ids{2, 3}));
}

TEST(SimCanBus, LosesAndCountsFrames) {
  SimCanBus bus;
  for (std::uint32_t id = 1; id <= 4; ++id) bus.push(frame(id, 10));
  bus.advance_to(10);
  bus.lose(2);
  EXPECT_EQ(receive(bus), (Ids{3, 4}));
  EXPECT_EQ(bus.dropped(), 2u);
}

TEST(SimCanBus, ReadsASourceAndItsLosses) {
  struct Source final : CanFrameSource {
    std::uint32_t given = 0;
    std::optional<CanFrame> next() noexcept override {
      if (given == 3) return std::nullopt;
      ++given;
      return frame(given, given * 10);
    }
    std::uint64_t dropped() const noexcept override { return given * 100; }
  } source;
  SimCanBus bus(&source);
  bus.advance_to(20);
  EXPECT_EQ(receive(bus), (Ids{1, 2}));
  bus.advance_to(100);
  EXPECT_EQ(receive(bus), Ids{3});
  EXPECT_EQ(bus.dropped(), 300u);
}

}  // namespace
}  // namespace zonepack
