// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/transitions.hpp"

namespace zonepack {

// A zone that the robot may be going to enter.
struct Coming {
  ZoneId zone = kNoZone;
  float share = 0;    // the probability that it is entered within the look ahead
  float seconds = 0;  // expected from entering the robot's present zone, if it is

  // Orders what is worth having in memory: the likelier and the sooner the more.
  float worth() const noexcept;
};

// Which zones come next, several steps ahead: those of a mission's route in its order, or else the
// likeliest ways through Transitions, the likeliest first.
//
// Real-time: no allocation; look() asks Transitions at most kMostLooks times.
// Threads: one.
class Foresight {
 public:
  static constexpr std::size_t kMost = 32;
  static constexpr std::size_t kMostLooks = 24;

  // From `now`, entered from `before`. `now` itself is not listed.
  void look(const Transitions& transitions, ZoneId before, ZoneId now) noexcept;

  // Along a route, whose zones after `now` are these; a zone that comes twice counts the first
  // time. transitions: for the seconds; may be null.
  void follow(std::span<const ZoneId> ahead, ZoneId before, ZoneId now,
              const Transitions* transitions) noexcept;

  void clear() noexcept {
    ++looks_;
    count_ = 0;
  }

  // Another number after each of the calls above.
  std::uint32_t looks() const noexcept { return looks_; }

  // The one worth most first, then the lowest ZoneId.
  std::span<const Coming> coming() const noexcept { return {all_.data(), count_}; }
  // 0 for a zone that is not listed.
  float worth(ZoneId zone) const noexcept;

 private:
  void add(ZoneId zone, float share, float seconds) noexcept;
  void sort() noexcept;

  std::array<Coming, kMost> all_{};
  std::size_t count_ = 0;
  std::uint32_t looks_ = 0;
};

}  // namespace zonepack
