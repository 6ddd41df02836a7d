// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "platform/can/can_bus.hpp"
#include "platform/can/can_errors.hpp"

// What every CanBus must do, whatever is behind it. A program includes this file once and names
// its rigs with INSTANTIATE_TEST_SUITE_P(NAME, CanBusContract, testing::Values(make_rig, ...)).
namespace zonepack {

// A bus under test, opened for kIds, and another node on the same wire.
class CanRig {
 public:
  static constexpr std::array<CanId, 2> kIds{CanId{.id = 0x123, .extended = false},
                                             CanId{.id = 0x18FF1234, .extended = true}};

  virtual ~CanRig() = default;
  virtual CanBus& bus() = 0;
  // By the other node; false when it cannot.
  virtual bool send(const CanFrame& frame) = 0;
  // Waits until sent frames have arrived and changes of the interface have been noticed.
  virtual void settle() = 0;
  virtual std::int64_t now_ns() = 0;  // on the clock of the stamps
  virtual void take_down() = 0;
  virtual void bring_up() = 0;
  // The contract skips what the hardware or kernel cannot do.
  virtual bool takes_fd() const { return true; }
  virtual bool can_inject_errors() const { return true; }
  virtual bool can_remove() const { return true; }
  virtual void remove() {}
  virtual void make_again() {}
  // The same bus with a queue so small that 500 frames do not fit; null where that cannot be.
  virtual CanBus* small_bus() { return nullptr; }
};

using CanRigMaker = std::function<std::unique_ptr<CanRig>()>;

class CanBusContract : public testing::TestWithParam<CanRigMaker> {
 protected:
  void SetUp() override {
    rig_ = GetParam()();
    ASSERT_TRUE(rig_) << "no such bus here";
  }

  static CanFrame frame(std::uint32_t id, std::uint8_t len, bool extended = false) {
    CanFrame made;
    made.id = id;
    made.extended = extended;
    made.len = len;
    for (std::uint8_t i = 0; i < len; ++i) made.data[i] = static_cast<std::uint8_t>(i + len);
    return made;
  }

  std::vector<CanFrame> receive(CanBus& bus, std::size_t most = 600) {
    rig_->settle();
    std::vector<CanFrame> into(most);
    into.resize(bus.receive(into));
    return into;
  }
  std::vector<CanFrame> receive(std::size_t most = 600) { return receive(rig_->bus(), most); }

  // The status once the bus has noticed a change.
  CanBusStatus status() {
    receive(0);
    return rig_->bus().status();
  }

  std::unique_ptr<CanRig> rig_;
};

inline bool same_but_stamp(const CanFrame& a, const CanFrame& b) {
  return a.id == b.id && a.extended == b.extended && a.fd == b.fd && a.rtr == b.rtr &&
         a.error == b.error && a.flags == b.flags && a.len == b.len && a.data == b.data;
}

TEST_P(CanBusContract, DeliversFramesAsTheyWereSentInOrder) {
  std::vector<CanFrame> sent{frame(0x123, 8), frame(0x18FF1234, 3, true), frame(0x123, 0)};
  if (rig_->takes_fd()) {
    for (const std::uint8_t len : {std::uint8_t{64}, std::uint8_t{12}}) {
      sent.push_back(frame(0x123, len));
      sent.back().fd = true;
      sent.back().flags = 1;
    }
  }
  for (const CanFrame& f : sent) ASSERT_TRUE(rig_->send(f));
  const auto got = receive();
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_TRUE(same_but_stamp(got[i], sent[i])) << i;
  EXPECT_EQ(rig_->bus().dropped(), 0u);
}

TEST_P(CanBusContract, LetsThroughOnlyTheIdsAskedFor) {
  CanFrame remote = frame(0x123, 0);
  remote.rtr = true;
  for (const CanFrame& f : {frame(0x124, 1), frame(0x123, 2, true), remote, frame(0x123, 3),
                            frame(0x234, 4), frame(0x18FF1235, 5, true)}) {
    ASSERT_TRUE(rig_->send(f));
  }
  const auto got = receive();
  ASSERT_EQ(got.size(), 1u);
  EXPECT_EQ(got[0].len, 3);
}

TEST_P(CanBusContract, StampsFramesAtArrivalNotAtReading) {
  const std::int64_t before_ns = rig_->now_ns();
  ASSERT_TRUE(rig_->send(frame(0x123, 1)));
  rig_->settle();
  const std::int64_t arrived_ns = rig_->now_ns();
  rig_->settle();
  rig_->settle();
  ASSERT_TRUE(rig_->send(frame(0x123, 2)));
  const auto got = receive();
  ASSERT_EQ(got.size(), 2u);
  EXPECT_GE(got[0].stamp_ns, before_ns);
  EXPECT_LE(got[0].stamp_ns, arrived_ns);
  EXPECT_GE(got[1].stamp_ns, arrived_ns);
  EXPECT_LE(got[1].stamp_ns, rig_->now_ns());
}

TEST_P(CanBusContract, GivesNoMoreThanAskedForAndKeepsTheRest) {
  for (std::uint8_t i = 0; i < 200; ++i) {
    CanFrame f = frame(0x123, 1);
    f.data[0] = i;
    while (!rig_->send(f)) rig_->settle();
  }
  const auto first = receive(70);  // more than fits one batch
  ASSERT_EQ(first.size(), 70u);
  EXPECT_EQ(receive(0).size(), 0u);
  const auto rest = receive();
  ASSERT_EQ(rest.size(), 130u);
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(rest[i].data[0], i + 70);
  EXPECT_EQ(receive().size(), 0u);
}

TEST_P(CanBusContract, CountsEveryFrameThatItsQueueCouldNotTake) {
  CanBus* const bus = rig_->small_bus();
  if (bus == nullptr) GTEST_SKIP() << "its queue cannot be made small";
  for (int i = 0; i < 500; ++i) {
    while (!rig_->send(frame(0x123, 1))) rig_->settle();
  }
  std::size_t got = receive(*bus).size();
  EXPECT_LT(got, 500u);
  ASSERT_TRUE(rig_->send(frame(0x123, 2)));  // brings the count
  got += receive(*bus).size();
  EXPECT_EQ(got + bus->dropped(), 501u);
  EXPECT_EQ(bus->status().dropped, bus->dropped());
}

TEST_P(CanBusContract, FollowsTheStatesThatErrorFramesTell) {
  if (!rig_->can_inject_errors()) GTEST_SKIP() << "error frames cannot be sent there";
  ASSERT_TRUE(rig_->send(error_frame(kCanErrorController, 0x10)));
  EXPECT_EQ(receive().size(), 1u);
  EXPECT_EQ(status().state, CanBusState::kPassive);
  ASSERT_TRUE(rig_->send(error_frame(kCanErrorBusOff)));
  EXPECT_EQ(receive().size(), 1u);
  EXPECT_EQ(status().state, CanBusState::kOff);
  ASSERT_TRUE(rig_->send(error_frame(kCanErrorRestarted)));
  const auto got = receive();
  ASSERT_EQ(got.size(), 1u);
  EXPECT_TRUE(got[0].error);
  EXPECT_EQ(status().state, CanBusState::kActive);
  EXPECT_EQ(status().bus_offs, 1u);
  EXPECT_EQ(status().restarts, 1u);
  EXPECT_EQ(status().error_frames, 3u);
}

TEST_P(CanBusContract, GivesNothingWhileDownAndGoesOnWhenUpAgain) {
  ASSERT_TRUE(rig_->send(frame(0x123, 1)));
  EXPECT_EQ(receive().size(), 1u);
  EXPECT_EQ(status().link, CanLink::kUp);
  for (int i = 0; i < 3; ++i) {
    rig_->take_down();
    EXPECT_EQ(status().link, CanLink::kDown);
    EXPECT_EQ(receive().size(), 0u);
    rig_->bring_up();
    EXPECT_EQ(status().link, CanLink::kUp);
    ASSERT_TRUE(rig_->send(frame(0x123, 2)));
    EXPECT_EQ(receive().size(), 1u);
  }
  EXPECT_EQ(status().reconnects, 0u);
}

TEST_P(CanBusContract, OpensWhateverBearsTheNameAfterItWasRemoved) {
  if (!rig_->can_remove()) GTEST_SKIP() << "it cannot be removed";
  for (std::uint64_t i = 1; i <= 3; ++i) {
    rig_->remove();
    EXPECT_EQ(status().link, CanLink::kAbsent);
    EXPECT_EQ(receive().size(), 0u);
    rig_->make_again();
    EXPECT_EQ(status().link, CanLink::kUp);
    EXPECT_EQ(status().reconnects, i);
    ASSERT_TRUE(rig_->send(frame(0x123, 2)));
    const auto got = receive();
    ASSERT_EQ(got.size(), 1u);
    EXPECT_LE(got[0].stamp_ns, rig_->now_ns());
  }
}

}  // namespace zonepack
