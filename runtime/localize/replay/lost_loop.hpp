// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/lost/lost_sweep.hpp"
#include "runtime/localize/lost/sight_watch.hpp"
#include "runtime/localize/lost/wheel_path.hpp"
#include "runtime/replay/fix_source.hpp"
#include "runtime/run/command_lines.hpp"

namespace zonepack::localize {

struct LoopImage;

// The features of one image. A failure is an image that cannot be read.
using ImageDescriber = std::function<Outcome<ImageFeatures>(const LoopImage& image)>;

// The part of a replay's camera that notices when the robot is lost, and finds it again: it has
// zones loaded by commands of the cycle, one after the other, within what the cycle allows.
//
// Time is the replay's: comparing a view with a signature is taken to last kPair_ns, so that the
// same input gives the same events everywhere.
class LostLoop {
 public:
  static constexpr std::int64_t kPair_ns = 300'000;

  struct Figures {
    std::size_t times_lost = 0;
    double lost_s = 0;
    std::size_t zones_looked_at = 0;  // each time
    std::size_t pairs = 0;            // of a view and a signature
    std::size_t turns_asked = 0;
  };

  // `matcher` outlives this object. start_lost: the run begins so.
  LostLoop(const Catalog& map, PlaceMatcher& matcher, ImageDescriber describe,
           std::uint32_t descriptor_bytes, bool start_lost);

  // Before anything else of a cycle.
  void follow(const FixMoment& moment);
  bool searching() const noexcept { return sweep_.active() && !given_ns_; }
  // An image, while searching.
  Outcome<void> see(const LoopImage& image);
  // An image's query, while not searching.
  void judge(const QueryResult& result, const FixMoment& moment);
  // Fixes once the robot is found, of images that were seen.
  std::vector<FoundFix> search(const FixMoment& moment);
  void command(const FixMoment& moment, std::vector<TimedCommand>& commands);

  // All that was commanded.
  const std::vector<TimedCommand>& commands() const noexcept { return commanded_; }
  double lost_for_s(std::int64_t now_ns) const noexcept {
    return static_cast<double>(now_ns - lost_since_ns_) * 1e-9;
  }
  const Figures& figures() const noexcept { return figures_; }
  const LostSweep& sweep() const noexcept { return sweep_; }

 private:
  void lose(const FixMoment& moment);
  void post(Command::Kind kind, ZoneId zone = kNoZone);

  LostSweep sweep_;
  SightWatch watch_;
  ImageDescriber describe_;
  std::uint32_t descriptor_bytes_;
  bool start_lost_;
  WheelPath wheels_{1'000'000'000};
  std::vector<Command> waiting_;
  std::vector<TimedCommand> commanded_;
  ZoneId sought_ = kNoZone;
  std::int64_t busy_until_ns_ = INT64_MIN, lost_since_ns_ = 0;
  std::optional<std::int64_t> given_ns_;  // when fixes were given that are not taken yet
  std::uint64_t images_ = 0;
  Figures figures_;
};

}  // namespace zonepack::localize
