// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "platform/devices/edge_filter.hpp"
#include "platform/devices/gpio_line.hpp"

namespace zonepack {

// GPIO chips whose lines a test drives and watches from outside, in simulated time. High and low
// are the levels on the wire.
//
// Threads: any.
class SimGpio final : public GpioPort {
 public:
  // Chips are named gpiochip0, gpiochip1, ... in the order in which they are added.
  void add_chip(const std::string& label, unsigned lines);
  void name_line(const std::string& label, unsigned line, const std::string& name);
  void remove_chip(const std::string& label);  // open lines then fail with ENODEV

  void advance_to(std::int64_t now_ns);  // time never runs back
  std::int64_t now_ns() const;

  void drive(const std::string& label, unsigned line, bool high);  // from outside
  bool is_high(const std::string& label, unsigned line) const;
  std::uint64_t changes(const std::string& label, unsigned line) const;  // by the program
  void occupy(const std::string& label, unsigned line, const std::string& consumer);
  void release(const std::string& label, unsigned line);
  void make_output(const std::string& label, unsigned line);  // in use by no program

  // While hanging, set() does not return: an expander on a bus that hangs.
  void hang(const std::string& label, bool hangs);
  // Calls of set() that are waiting now.
  int hanging() const;

  Result<GpioLineInfo> look(const GpioLineName& name) override;
  Result<std::unique_ptr<GpioOutput>> open(const GpioOutputSettings& settings) override;
  Result<std::unique_ptr<GpioInput>> open(const GpioInputSettings& settings) override;

 private:
  static constexpr std::size_t kQueue = 16;  // edges that wait; more are lost, as in the kernel

  struct Line {
    std::string name, consumer;
    bool high = false;
    bool output = false;
    bool watched = false;
    std::uint64_t changes = 0;
    std::deque<GpioEdge> edges;  // "active" is high
  };
  struct Wire {
    std::string name, label;
    std::vector<Line> lines;
    bool gone = false;
    bool hangs = false;
  };
  class Output;
  class Input;
  struct Place {
    Wire* wire = nullptr;
    Line* line = nullptr;
    unsigned number = 0;
  };

  Result<Place> find(const GpioLineName& name);
  Wire* wire(const std::string& label) const;
  Line& line(const std::string& label, unsigned number) const;

  mutable std::mutex mutex_;
  std::condition_variable moved_;
  std::vector<std::unique_ptr<Wire>> wires_;
  std::int64_t now_ns_ = 0;
  int hanging_ = 0;
};

}  // namespace zonepack
