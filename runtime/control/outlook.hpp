// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/control/command.hpp"
#include "runtime/zones/foresight.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/transitions.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// Which zones are worth loading before the robot's path leads to them: those of the route that it
// was given, or else those that are likely by where it went before.
//
// Real-time: no allocation; a change of zone costs one look of Foresight.
// Threads: owned by the control thread.
class Outlook {
 public:
  static constexpr std::size_t kMostLikely = 8;

  struct Likely {
    ZoneId zone = kNoZone;
    // Earlier there is time to learn more, and on a route only free room is taken: what is evicted
    // early, before the robot has left a zone that it needs less, is loaded once more.
    std::int64_t from_ns = 0;
  };

  // load_s: by ZoneId, estimated seconds from request to use. transitions: what is known of the
  // robot's habits; null: nothing. learns: they are counted on. All that is referred to outlives
  // this object.
  Outlook(const ZoneGraph& graph, std::span<const float> load_s, Transitions* transitions,
          const PreloadSettings& settings, bool learns);

  // The robot's zone is this since t_ns; kNoZone: it is not known where. Call when it changes.
  void enter(ZoneId own, std::int64_t t_ns) noexcept;

  // Zones that the robot, which is in `own`, will go through, in their order, at most
  // Command::kMostRoute; those that the map does not have are left out. None: it has no route.
  void hint(std::span<const ZoneId> route, ZoneId own) noexcept;

  // The zones of the route after the robot's own; none when it is not on the route.
  std::span<const ZoneId> ahead(ZoneId own) const noexcept;
  // The zone that the robot came from.
  ZoneId before() const noexcept { return steps_.before(); }

  // On a route in its order, else the one worth most first.
  std::span<const Likely> likely() const noexcept { return {likely_.data(), likely_count_}; }
  const Foresight& foresight() const noexcept { return foresight_; }

  // What another map's outlook knows of the robot's habits.
  void take_over(const Outlook& other) noexcept;

 private:
  void look_from(ZoneId own) noexcept;
  void step_on_route(ZoneId own) noexcept;
  void foresee(ZoneId own) noexcept;

  const ZoneGraph& graph_;
  std::span<const float> load_s_;
  Transitions* transitions_;
  bool preloads_;  // what is likely to come
  bool learns_;
  double pays_;
  std::array<ZoneId, Command::kMostRoute> route_{};
  std::size_t route_length_ = 0;
  std::size_t route_place_ = 0;  // where the robot was last on the route
  ZoneSteps steps_;
  Foresight foresight_;
  std::array<Likely, kMostLikely> likely_{};
  std::size_t likely_count_ = 0;
};

}  // namespace zonepack
