// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/control/command.hpp"
#include "runtime/localize/lost/lost_sweep.hpp"
#include "runtime/localize/lost/sight_watch.hpp"
#include "runtime/localize/lost/wheel_path.hpp"

namespace zonepack::localize {

// What a search needs of the zones in memory and of what has them loaded.
class SearchWorld {
 public:
  virtual ~SearchWorld() = default;
  virtual bool resident(ZoneId zone) const = 0;
  // All features of a resident zone; nothing when it was unloaded meanwhile.
  virtual std::optional<std::vector<MapFeatures>> read(ZoneId zone) = 0;
  // kLost, kSeek of a zone, kAskTurn.
  virtual Result<void> command(Command::Kind kind, ZoneId zone) = 0;
};

// Notices that the robot is lost, and leads the search step by step, live as in a replay.
//
// Threads: one.
class SearchDriver {
 public:
  // Fixes that were given and that the pose does not follow within this were not believed.
  static constexpr std::int64_t kBelieved_ns = 1'000'000'000;

  struct Figures {
    std::size_t zones_looked_at = 0;  // each time
    std::size_t pairs = 0;            // of a view and a signature
    std::size_t turns_asked = 0;
  };

  // Both outlive this object.
  SearchDriver(std::vector<SearchZone> map, PlaceMatcher& matcher, SearchWorld& world)
      : sweep_(std::move(map), matcher), world_(world) {}

  // Where the robot is by its wheels alone.
  void follow(std::int64_t t_ns, const Pose2& T_wheels_base) { wheels_.add(t_ns, T_wheels_base); }
  // An image's query while nothing is searched. True: the robot is lost.
  bool notices(const QueryResult& result, bool trusted, bool own_zone) noexcept {
    return !active() && watch_.add(result, trusted, own_zone);
  }
  // `last`: the zone where the robot was thought to be.
  Result<void> begin(std::int64_t now_ns, ZoneId last);
  void end();
  bool active() const noexcept { return sweep_.active(); }
  std::int64_t begun_ns() const noexcept { return begun_ns_; }
  // Fixes were given, and it is not known yet whether they are believed.
  bool waits(std::int64_t now_ns) const noexcept {
    return given_ns_ && now_ns - *given_ns_ <= kBelieved_ns;
  }

  // An image while searching. False: nothing is known of the wheels.
  bool see(std::int64_t stamp_ns, ImageFeatures features);
  // At most one zone. Fixes once the robot is found, of images that were seen.
  Result<std::vector<FoundFix>> step(std::int64_t now_ns);

  const LostSweep& sweep() const noexcept { return sweep_; }
  const Figures& figures() const noexcept { return figures_; }

 private:
  void look(ZoneId zone);

  LostSweep sweep_;
  SightWatch watch_;
  WheelPath wheels_{6'000'000'000};
  SearchWorld& world_;
  ZoneId sought_ = kNoZone;
  std::int64_t begun_ns_ = 0;
  std::optional<std::int64_t> given_ns_;
  std::uint64_t images_ = 0;
  Figures figures_;
};

// That a zone was passed over, and what to do, after a zone's name.
std::string passed_over_text(const std::string& zone, const std::string& advice);

}  // namespace zonepack::localize
