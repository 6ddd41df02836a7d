// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/run/run.hpp"
#include "runtime/zones/transitions.hpp"

namespace zonepack {

// Which zones a robot was in, in their order.
struct ZoneDrive {
  struct Visit {
    std::int64_t t_ns = 0;  // entered
    std::string zone;       // empty: not known, or in none
  };
  std::string name;  // the file, for messages
  std::vector<Visit> visits;
};

// Takes the visits from the events of a run.
class DriveListener final : public RunObserver {
 public:
  void on_event(const Event& event, const MapVersion& map) noexcept override;
  std::vector<ZoneDrive::Visit> visits;
};

// A text file of `stamp zone` lines; stamps in seconds or whole nanoseconds. Lines may repeat the
// zone, and # begins a remark. Failures name file:line.
Outcome<ZoneDrive> read_zone_file(const std::string& path);

// What a recording's run decided on: it is replayed.
Outcome<ZoneDrive> read_recorded_drive(const std::string& path);

// A CAN log with its fixes, replayed by the settings on a map; no pack is read.
Outcome<ZoneDrive> read_logged_drive(const std::string& config, const std::string& map,
                                     const std::string& can, const std::string& corrections);

// A recording if it is the folder of a flight recorder or begins as one, else a zone file.
Outcome<ZoneDrive> read_drive(const std::string& path);

}  // namespace zonepack
