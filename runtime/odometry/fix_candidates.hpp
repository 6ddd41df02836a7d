// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/odometry/odometry_history.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {

// Places where the robot may be, each backed by fixes that agree with each other through odometry:
// the hypotheses before a pose is trusted, and afterwards the runs of refused fixes. A given start
// pose is one of them, without a fix.
//
// A candidate is anchored at an entry of the history, that of its last fix, so that a later fix is
// compared where it was taken.
// Real-time: no allocation; at most kMaxHypotheses candidates.
class FixCandidates {
 public:
  struct Candidate {
    std::uint64_t anchor = 0;
    UncertainPose at_anchor;
    UncertainPose now;  // at the newest entry
    std::uint32_t fixes = 0;
    std::uint32_t run = 0;     // of these, since interrupt()
    std::int64_t last_ns = 0;  // when the last of them was taken
    bool near_guess = false;   // its first fix lay within the gate of the given start
  };

  void clear() noexcept { count_ = 0; }

  // Adds a given start at the newest entry and forgets all others.
  void guess(const OdometryHistory& history, const UncertainPose& pose) noexcept;

  // Adds a fix, given at entry `index`, to the candidate that it agrees with best (within the gate,
  // a squared Mahalanobis distance), or makes it a new one in place of the weakest. Returns the
  // candidate that was confirmed; nothing for a new one. keep_first: the best one keeps its place.
  std::optional<Candidate> add(const OdometryHistory& history, const UncertainPose& fix,
                               std::uint64_t index, double gate_chi2, bool keep_first) noexcept;

  // A fix was accepted elsewhere: runs start over, and candidates without a fix in the last
  // kMemory_ns are dropped.
  void interrupt(std::int64_t t_ns) noexcept;

  // Writes the candidates with at least `least_fixes` to `into` from index `first` on, best first:
  // by most fixes; a given start before a single fix that contradicts it; of single fixes the
  // older. Returns the index after the last.
  std::size_t list(std::array<PoseHypothesis, kMaxHypotheses>& into, std::size_t first,
                   std::uint32_t least_fixes) const noexcept;

  // Changes of the history, reported before or after they happen, as the names say.
  void after_step(const UncertainPose& step) noexcept;  // at its newest end
  void before_oldest_goes(const OdometryHistory& history) noexcept;
  void after_split(std::uint64_t index) noexcept;  // entries from index on are renumbered
  void after_rewrite(const OdometryHistory& history) noexcept;  // steps changed
  void after_restart(const OdometryHistory& history) noexcept;  // one entry, poses stay
  bool stand_on(std::uint64_t index) const noexcept;

 private:
  static constexpr std::int64_t kMemory_ns = 6'000'000'000;

  Candidate& place_for_new(const Candidate* spared) noexcept;
  const Candidate* first() const noexcept;  // as list() orders them; null without any

  std::array<Candidate, kMaxHypotheses> all_;
  std::size_t count_ = 0;
};

}  // namespace zonepack
