// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/evaluate/bounds.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

// What a run's events say besides its statistics: requests and hits, reads that were of no use, how
// well the next zone was foreseen, and the steps for the bounds. For runs of one map.
//
// Memory: grows with the run's changes of wanted zones.
class DriveAccount final : public RunObserver {
 public:
  // The pinned zones are those of the settings. `model` outlives this object.
  DriveAccount(const MapModel& model, const LoadRates& rates);

  void on_event(const Event& event, const MapVersion& map) noexcept override;
  // After the last event.
  void end() noexcept;

  // Zones that became wanted, and how many of these were in memory.
  std::uint64_t requests() const noexcept { return requests_; }
  std::uint64_t hits() const noexcept { return hits_; }
  // Zones that the robot entered, the first one included.
  std::uint64_t entered() const noexcept { return entered_; }
  // Read for loads that were cancelled, and for zones that the robot was not in before they were
  // evicted or the run ended.
  ByteCount bytes_read() const noexcept { return bytes_read_; }
  ByteCount bytes_unused() const noexcept { return bytes_unused_; }

  // Changes from one zone to another; and in how many the zone entered was the first, or one of the
  // first two, that became wanted ahead of the robot while it was in the zone before.
  struct Foreseen {
    std::uint64_t changes = 0, first = 0, first_two = 0;
  };
  const Foreseen& foreseen() const noexcept { return foreseen_; }

  // At each, the wanted and pinned zones that were held: resident, or being loaded by a load that
  // was completed. They are charged, so they fit together. After end().
  const RequestSteps& steps() const noexcept { return steps_; }

 private:
  struct Zone {
    bool wanted = false, pinned = false, resident = false, held = false, required = false;
    bool entered = false;  // the robot was in it since its last load began
    std::size_t load = 0;  // its last, by the number of loads
    std::int64_t load_began_ns = 0;
    std::uint64_t wanted_since = 0;  // by the number of requests
  };

  // A zone of a step, by the load that it was held by.
  struct HeldBy {
    ZoneId zone;
    std::size_t load;
  };

  void enter(ZoneId zone);
  void want(ZoneId zone);
  void begin_load(const Event& event);
  void stop_load(const Event& event);
  void settle(ZoneId zone);  // whether it is required has changed, or not
  void end_step();
  void leave_memory(ZoneId zone);

  const MapModel& model_;
  LoadRates rates_;
  std::vector<Zone> zones_;    // by ZoneId
  ZoneId zone_ = kNoZone;      // the robot's own
  std::vector<ZoneId> ahead_;  // that became wanted while it was in it, at most two
  std::vector<HeldBy> required_;
  bool grown_ = false;  // required_, since the last step
  std::vector<std::vector<HeldBy>> held_steps_;
  std::vector<bool> given_up_;  // by load
  RequestSteps steps_;
  std::uint64_t requests_ = 0, hits_ = 0, entered_ = 0;
  ByteCount bytes_read_ = 0, bytes_unused_ = 0;
  Foreseen foreseen_;
};

}  // namespace zonepack
