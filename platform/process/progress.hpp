// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <ostream>
#include <string>

namespace zonepack {

// Reports the progress of a long stage: on a terminal by a line that is redrawn (count, rate, time
// left), else by one line when the stage ends.
//
// Threads: advance() by any; the rest by one.
class Progress {
 public:
  // `terminal`: whether `out` is a terminal.
  Progress(std::ostream& out, bool terminal) : out_(out), terminal_(terminal) {}

  void start(std::string stage, std::size_t total, std::string unit);
  void advance(std::size_t count = 1);
  // Ends the stage with a line; `note` gives the result.
  void finish(const std::string& note);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(std::size_t done, Clock::time_point now);

  std::ostream& out_;
  bool terminal_;
  std::string stage_, unit_;
  std::size_t total_ = 0;
  std::atomic<std::size_t> done_ = 0;
  Clock::time_point begin_;
  Clock::time_point drawn_;
  std::mutex mutex_;
};

}  // namespace zonepack
