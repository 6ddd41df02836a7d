// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/localize/lost/lost_view.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

// Notices that the robot is not where it is thought to be: images in which the map's signatures
// should be seen, and none fits. One image says nothing: people walk by, furniture moves.
class SightWatch {
 public:
  // Images in a row without a fix. A pose that two fixes agreed on deserves more patience.
  static constexpr int kMostAgainst = 12, kMostAgainstGuess = 5;
  static constexpr int kMostMissed = 40, kMostMissedGuess = 12;

  // An image's query. own_zone: the robot's own zone was resident, or it is said to be in none.
  // True: the robot is lost.
  bool add(const QueryResult& result, bool trusted, bool own_zone) noexcept {
    if (result.accepted) {
      restart();
      return false;
    }
    // All that is near points of the map, however they were seen: several images in a row make up
    // for that, and a wrong pose is noticed in half the time.
    const bool against = speaks_against(result.distinct, result.visible);
    const bool missed =
        own_zone && (result.signatures > 0 || result.reason == Reason::kNoSignature);
    // A dark image misses nothing.
    if (result.reason == Reason::kNoFeatures || result.reason == Reason::kWrongSize) return false;
    against_ += against ? 1 : 0;
    missed_ += missed ? 1 : 0;
    return against_ >= (trusted ? kMostAgainst : kMostAgainstGuess) ||
           missed_ >= (trusted ? kMostMissed : kMostMissedGuess);
  }
  void restart() noexcept { against_ = missed_ = 0; }
  int against() const noexcept { return against_; }
  int missed() const noexcept { return missed_; }

 private:
  int against_ = 0, missed_ = 0;
};

}  // namespace zonepack::localize
