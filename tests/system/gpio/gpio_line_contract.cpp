// SPDX-License-Identifier: Apache-2.0
// usage: gpio_line_contract, as root: the contract of tests/support/gpio_line_contract.hpp on chips
// that the kernel's gpio-sim makes. Where it is not loaded nothing is tested, and that is said.
#include "tests/support/gpio_line_contract.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;

const fs::path kSims = "/sys/kernel/config/gpio-sim";

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text << std::flush;
}

std::string get(const fs::path& file) {
  std::string text;
  std::getline(std::ifstream(file), text);
  return text;
}

class SimulatedChip {
 public:
  SimulatedChip(const std::string& name, const std::string& label) : folder_(kSims / name) {
    fs::create_directories(folder_ / "bank0/line3");
    put(folder_ / "bank0/num_lines", "8");
    put(folder_ / "bank0/label", label);
    put(folder_ / "bank0/line3/name", "door");
    put(folder_ / "live", "1");
    chip_ = get(folder_ / "bank0/chip_name");
    lines_ = "/sys/devices/platform/" + get(folder_ / "dev_name") + "/" + chip_;
  }
  ~SimulatedChip() {
    put(folder_ / "live", "0");
    for (const char* part : {"bank0/line3", "bank0", ""}) fs::remove(folder_ / part);
  }
  fs::path line(unsigned number) const { return lines_ / ("sim_gpio" + std::to_string(number)); }
  const std::string& chip() const { return chip_; }

 private:
  fs::path folder_, lines_;
  std::string chip_;
};

class KernelGpioRig final : public GpioRig {
 public:
  ~KernelGpioRig() override {
    if (holder_ != nullptr) pclose(holder_);
  }
  GpioPort& port() override { return kernel_gpio(); }
  std::string label() override { return "contract"; }
  std::string chip_name() override { return chip_.chip(); }
  void add_twin() override { twin_ = std::make_unique<SimulatedChip>("twin", label()); }
  void drive(unsigned line, bool high) override {
    put(chip_.line(line) / "pull", high ? "pull-up" : "pull-down");
  }
  bool is_high(unsigned line) override { return get(chip_.line(line) / "value") == "1"; }
  void occupy(unsigned line) override {
    // Ends when its input does.
    const std::string command =
        "gpioset -m wait " + chip_.chip() + " " + std::to_string(line) + "=0";
    holder_ = popen(command.c_str(), "w");
    for (int i = 0; i < 500 && port().look({chip_name(), std::to_string(line)})->consumer.empty();
         ++i) {
      pass(10'000'000);
    }
  }
  std::int64_t now_ns() override { return monotonic_ns(); }
  void pass(std::int64_t ns) override { sleep_until_ns(monotonic_ns() + ns); }

 private:
  SimulatedChip chip_{"contract", "contract"};
  std::unique_ptr<SimulatedChip> twin_;
  FILE* holder_ = nullptr;
};

std::unique_ptr<GpioRig> kernel_rig() {
  if (!fs::exists(kSims)) {
    std::cout << "NOT TESTED: this kernel has no gpio-sim; toolchains/run system has one\n";
    return nullptr;
  }
  return std::make_unique<KernelGpioRig>();
}

INSTANTIATE_TEST_SUITE_P(Kernel, GpioLineContract, testing::Values(kernel_rig),
                         [](const auto&) { return std::string("gpio_sim"); });

}  // namespace
}  // namespace zonepack
