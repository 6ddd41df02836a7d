// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/localize/lost/search_driver.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/run/fix_counters.hpp"
#include "runtime/localize/run/zoned_link.hpp"

namespace zonepack::localize {

// The part of `zoneloc run` that notices when the robot is lost, and finds it again: zoned loads
// one zone after the other, and each is read in its memory and compared with the buffered views.
//
// Threads: one.
class LiveSearch final : private SearchWorld {
 public:
  using Say = std::function<void(const std::string&)>;

  // Of one map and its features; all outlive this object.
  LiveSearch(ZonedLink& link, std::vector<SearchZone> zones, Localizer& localizer,
             const DetectorSettings& detector, FixCounters& counters, Say say);

  bool searching() const noexcept { return driver_.active(); }
  // What zoned says about the robot, as often as it is asked: the path of the wheels.
  void follow(const RobotState& state);
  // An image while searching, stamped on the run's clock.
  void see(const GreyImage& image, std::int64_t run_ns);
  // An image's query while not searching, or an image without a pose to look from. Errors are
  // zoned's.
  Result<void> judge(const QueryResult& result, const RobotState& state);
  Result<void> begin(const RobotState& state);
  // One step of the search: at most one zone. Fixes are on the run's clock.
  Result<std::vector<FoundFix>> step(const RobotState& state);

 private:
  bool resident(ZoneId zone) const override { return link_.resident(zone); }
  std::optional<std::vector<MapFeatures>> read(ZoneId zone) override;
  Result<void> command(Command::Kind kind, ZoneId zone) override;
  void report();

  ZonedLink& link_;
  ImageMatcher matcher_;
  Localizer& localizer_;
  std::uint32_t descriptor_bytes_;
  FixCounters& counters_;
  Say say_;
  SearchDriver driver_;
  std::size_t told_passed_over_ = 0;
  std::uint64_t images_ = 0;  // of this search
};

}  // namespace zonepack::localize
