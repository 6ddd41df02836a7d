// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "platform/memory/seqlock.hpp"
#include "runtime/run/figures/live_status.hpp"

namespace zonepack {

// How one line of the robot stands.
struct LineRow {
  LineRow(std::string line_name, bool is_output) : name(std::move(line_name)), output(is_output) {}
  const std::string name;  // "map_ready", "zone_markers.door"
  const bool output;
  std::atomic<bool> working{false};  // open, and its last call went well
  std::atomic<bool> active{false};
  std::atomic<std::uint64_t> changes{0};
  std::atomic<std::uint64_t> failures{0};  // calls that failed
};

// Where the threads of lines publish how their lines stand, for the service.
//
// Threads: add() before any other starts; each row is written by the thread of its line and read by
// any.
class LineBoard {
 public:
  LineRow& add(std::string name, bool output) {
    return rows_.emplace_back(std::move(name), output);
  }
  const std::deque<LineRow>& rows() const noexcept { return rows_; }

  // From the end of a load to map_ready on its line.
  Seqlock<TimingFigures> ready_latency;

 private:
  std::deque<LineRow> rows_;
};

}  // namespace zonepack
