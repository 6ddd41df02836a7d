// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "platform/base/result.hpp"

namespace zonepack {

// One pin of a GPIO controller. "Active" is the logical state; active_low maps it to a voltage.
struct GpioLineName {
  std::string chip;  // its label (robot), name (gpiochip0) or device file (/dev/gpiochip0)
  std::string line;  // its number on the chip (5), or its name
};

enum class GpioBias : std::uint8_t { kAsIs, kNone, kPullUp, kPullDown };

struct GpioOutputSettings {
  GpioLineName name;
  bool active_low = false;
  bool active = false;  // state from the moment it is opened
};

struct GpioInputSettings {
  GpioLineName name;
  bool active_low = false;
  GpioBias bias = GpioBias::kAsIs;
  std::int64_t debounce_ns = 0;  // a level counts once it has lasted this long
};

// How a line is set up, read without changing it.
struct GpioLineInfo {
  std::string chip;  // "gpiochip0 (robot)"
  unsigned number = 0;
  std::string name;      // empty: none
  std::string consumer;  // the program that uses it; empty: none
  bool output = false;   // as set up now
};

struct GpioEdge {
  std::int64_t stamp_ns = 0;  // CLOCK_MONOTONIC, when the line changed to its settled level
  bool active = false;
};

// A line that this program drives. Destroying the object releases the line in its current state, so
// set the final state first.
//
// Real-time: set() may take as long as the bus that the chip is on.
// Threads: one.
class GpioOutput {
 public:
  virtual ~GpioOutput() = default;
  virtual Result<void> set(bool active) noexcept = 0;  // kIo with errno
};

// A line that this program watches.
//
// Threads: one.
class GpioInput {
 public:
  virtual ~GpioInput() = default;

  // Takes the edges that have settled by now, oldest first, alternating between active and
  // inactive; an input that is active when opened begins with an active edge. Never waits. Work is
  // bounded by into.size(). kIo with errno: the chip is gone.
  virtual Result<std::size_t> take(std::span<GpioEdge> into) noexcept = 0;
};

// Finds and opens lines.
//
// Errors: kNotFound: detail kNoChip or kNoLine; kExists: several chips have that label; kBusy:
// already in use; kMismatch: set up as an output where an input is expected; kIo: errno.
class GpioPort {
 public:
  static constexpr std::int64_t kNoChip = 0, kNoLine = 1;

  virtual ~GpioPort() = default;
  virtual Result<GpioLineInfo> look(const GpioLineName& name) = 0;
  virtual Result<std::unique_ptr<GpioOutput>> open(const GpioOutputSettings& settings) = 0;
  virtual Result<std::unique_ptr<GpioInput>> open(const GpioInputSettings& settings) = 0;
};

// The kernel's chips.
//
// Threads: any.
GpioPort& kernel_gpio();

// The message for an error of open(): what is wrong and how to fix it.
std::string explain_gpio(GpioPort& port, const GpioLineName& name, const Error& error);

}  // namespace zonepack
