// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/protocol/messages.hpp"

// The parts of the Prometheus text that are not figures of the status.
namespace zonepack {

// What runs: zoned_build_info{version="0.1.0",commit="...",...} 1.
std::string build_metrics(const wire::Welcome& welcome);

// A series for each zone that zoned counts (512 at most, those that something happened to).
class ZoneMetrics {
 public:
  void add(const wire::Zone& zone);
  std::string text() const;

 private:
  struct Row {
    std::string labels;
    bool resident = false;
    std::uint64_t charged_bytes = 0, loads = 0, evictions = 0, entered = 0;
    std::int64_t last_load_ns = 0;
  };
  std::vector<Row> rows_;
};

}  // namespace zonepack
