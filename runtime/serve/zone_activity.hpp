// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/control/event.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What has happened to each zone since the map is in use, as events report it, for charts.
//
// Bounds: kMostZones zones, the first that anything happens to; a map may have many more, and a
// chart of them shows nothing.
// Memory: 16 KiB, whatever the map; allocated with the first event.
// Threads: one, the server's.
class ZoneActivity {
 public:
  static constexpr std::size_t kMostZones = 512;

  struct Row {
    ZoneId zone = kNoZone;
    std::uint32_t loads = 0, evictions = 0, entered = 0;
    std::int64_t last_load_ns = 0;   // how long it took, on the run's clock
    std::int64_t load_began_ns = 0;  // since the start of the run
  };

  void take(const Event& event);

  // Zeros for a zone that is not counted.
  Row of(ZoneId zone) const noexcept;
  // By zone.
  std::span<const Row> rows() const noexcept { return rows_; }

 private:
  Row* find_or_add(ZoneId zone);

  std::vector<Row> rows_;
};
static_assert(sizeof(ZoneActivity::Row) <= 32);

}  // namespace zonepack
