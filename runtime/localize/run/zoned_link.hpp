// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "platform/base/failure.hpp"
#include "runtime/client/client.hpp"
#include "runtime/localize/camera/image_source.hpp"
#include "runtime/localize/lost/zone_order.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/localize/run/fix_counters.hpp"
#include "runtime/localize/run/resident_features.hpp"

namespace zonepack::localize {

// What zoned said about the robot at one moment.
struct RobotState {
  bool has_pose = false;
  std::int64_t pose_ns = 0;  // the run's clock
  QueryPrior pose;
  double speed_m_s = 0, yaw_rate_rad_s = 0;
  bool trusted = false;          // two fixes agreed
  bool lost = false;             // LosePose was taken, and no two fixes agreed since
  bool own_resident = false;     // the robot's own zone is in memory, or it is in none
  ZoneId zone = kNoZone;         // the robot's own
  std::optional<Pose2> wheels;   // at run_ns, by the wheels alone; an older zoned does not say
  std::int64_t run_ns = 0;       // the run's clock, of the last cycle
  std::int64_t offset_ns = 0;    // CLOCK_REALTIME minus the run's clock
  std::int64_t received_ns = 0;  // CLOCK_MONOTONIC
};

// An image's stamp on the run's clock. real_minus_monotonic_ns: clock_offset_ns().
std::int64_t on_run_clock(std::int64_t stamp_ns, ImageClock clock, const RobotState& state,
                          std::int64_t real_minus_monotonic_ns) noexcept;

// Where the robot was, or will be, at `run_ns`, if it moves as it does: wider by a tenth of the
// way.
QueryPrior pose_at(const RobotState& state, std::int64_t run_ns) noexcept;

// zoneloc's connection to zoned: asks where the robot is, gives fixes, reads zones in its memory.
// Errors: kCancelled and kNotFound: zoned is gone; others pass.
//
// Threads: one.
class ZonedLink final : public ZonesInMemory {
 public:
  static Outcome<ZonedLink> open(const std::string& socket);

  // What found the map's features; nothing from a zoned that does not say.
  std::optional<std::string> detector() const;

  Result<RobotState> state();
  Result<void> give(const QueryResult& fix, std::int64_t stamp_ns, ImageClock clock);
  Result<void> report(const FixCounters& counters, const std::string& camera);

  // The commands of a search (PROTOCOL.md).
  Result<void> lose_pose();
  Result<void> seek(ZoneId zone);
  Result<void> ask_turn();
  // The zones of the map, without doors: the protocol has none.
  Result<std::vector<SearchZone>> search_zones();

  std::uint32_t epoch() const noexcept override { return client_.reader().epoch(); }
  std::uint32_t zones() const noexcept override { return client_.reader().zone_count(); }
  bool resident(ZoneId zone) const noexcept override { return client_.reader().resident(zone); }
  ReadStatus read(ZoneId zone, const Fn& fn) override { return client_.reader().read(zone, fn); }
  void hold(ZoneId zone, const std::function<void()>& fn) override;

 private:
  explicit ZonedLink(Client client) : client_(std::move(client)) {}
  mutable Client client_;
};

}  // namespace zonepack::localize
