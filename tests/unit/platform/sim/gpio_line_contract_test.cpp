// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gpio_line_contract.hpp"

#include "platform/sim/sim_gpio.hpp"

namespace zonepack {
namespace {

class SimGpioRig final : public GpioRig {
 public:
  SimGpioRig() {
    gpio_.add_chip("first", 2);
    gpio_.add_chip("robot", 8);
    gpio_.name_line("robot", 3, "door");
    gpio_.advance_to(1'000'000'000);
  }
  GpioPort& port() override { return gpio_; }
  std::string label() override { return "robot"; }
  std::string chip_name() override { return "gpiochip1"; }
  void add_twin() override { gpio_.add_chip("robot", 8); }
  void drive(unsigned line, bool high) override {
    pass(1);
    gpio_.drive("robot", line, high);
  }
  bool is_high(unsigned line) override { return gpio_.is_high("robot", line); }
  void occupy(unsigned line) override { gpio_.occupy("robot", line, "gpioset"); }
  std::int64_t now_ns() override { return gpio_.now_ns(); }
  void pass(std::int64_t ns) override { gpio_.advance_to(gpio_.now_ns() + ns); }

 private:
  SimGpio gpio_;
};

INSTANTIATE_TEST_SUITE_P(Sim, GpioLineContract,
                         testing::Values([] { return std::make_unique<SimGpioRig>(); }),
                         [](const auto&) { return std::string("chip"); });

}  // namespace
}  // namespace zonepack
