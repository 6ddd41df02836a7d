// SPDX-License-Identifier: Apache-2.0
#include "tests/support/can_bus_contract.hpp"

#include "platform/sim/sim_can_bus.hpp"

namespace zonepack {
namespace {

class SimRig final : public CanRig {
 public:
  SimRig() {
    for (SimCanBus* bus : {&bus_, &small_}) {
      bus->only({kIds.begin(), kIds.end()});
      bus->advance_to(now_ns_);
    }
    small_.limit_queue(16);
  }
  CanBus& bus() override { return bus_; }
  CanBus* small_bus() override { return &small_; }
  bool send(const CanFrame& frame) override {
    CanFrame sent = frame;
    sent.stamp_ns = ++now_ns_;
    for (SimCanBus* bus : {&bus_, &small_}) bus->push(sent);
    return true;
  }
  void settle() override {
    now_ns_ += 1000;
    for (SimCanBus* bus : {&bus_, &small_}) bus->advance_to(now_ns_);
  }
  std::int64_t now_ns() override { return now_ns_; }
  void take_down() override { bus_.set_link(CanLink::kDown); }
  void bring_up() override { bus_.set_link(CanLink::kUp); }
  void remove() override { bus_.set_link(CanLink::kAbsent); }
  void make_again() override { bus_.set_link(CanLink::kUp); }

 private:
  std::int64_t now_ns_ = 1'000'000'000;
  SimCanBus bus_, small_;
};

INSTANTIATE_TEST_SUITE_P(Sim, CanBusContract,
                         testing::Values([] { return std::make_unique<SimRig>(); }),
                         [](const auto&) { return std::string("bus"); });

}  // namespace
}  // namespace zonepack
