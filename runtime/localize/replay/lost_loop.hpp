// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/features/image_features.hpp"
#include "runtime/localize/lost/search_driver.hpp"
#include "runtime/replay/fix_source.hpp"
#include "runtime/run/inputs/command_lines.hpp"

namespace zonepack::localize {

struct LoopImage;

// The features of one image. A failure is an image that cannot be read.
using ImageDescriber = std::function<Outcome<ImageFeatures>(const LoopImage& image)>;

// The part of a replay's camera that notices when the robot is lost, and finds it again: it has
// zones loaded by commands of the cycle, one after the other, within what the cycle allows.
//
// Time is the replay's: comparing a view with a signature is taken to last kPair_ns, so that the
// same input gives the same events everywhere.
class LostLoop final : private SearchWorld {
 public:
  static constexpr std::int64_t kPair_ns = 300'000;

  struct Figures : SearchDriver::Figures {
    std::size_t times_lost = 0;
    double lost_s = 0;
  };

  // `matcher` outlives this object. start_lost: the run begins so.
  LostLoop(const Catalog& map, PlaceMatcher& matcher, ImageDescriber describe,
           std::uint32_t descriptor_bytes, bool start_lost)
      : driver_(search_zones(map), matcher, *this),
        describe_(std::move(describe)),
        descriptor_bytes_(descriptor_bytes),
        start_lost_(start_lost) {}

  // Before anything else of a cycle.
  void follow(const FixMoment& moment);
  bool searching() const noexcept { return driver_.active() && !driver_.waits(now_ns_); }
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
    return static_cast<double>(now_ns - driver_.begun_ns()) * 1e-9;
  }
  Figures figures() const noexcept { return {driver_.figures(), times_lost_, lost_s_}; }
  const LostSweep& sweep() const noexcept { return driver_.sweep(); }

 private:
  void lose(const FixMoment& moment);
  const ResidentZones::Zone* find(ZoneId zone) const noexcept;
  bool resident(ZoneId zone) const override { return find(zone) != nullptr; }
  std::optional<std::vector<MapFeatures>> read(ZoneId zone) override;
  Result<void> command(Command::Kind kind, ZoneId zone) override;

  SearchDriver driver_;
  ImageDescriber describe_;
  std::uint32_t descriptor_bytes_;
  bool start_lost_;
  const ResidentZones* resident_ = nullptr;  // during search()
  std::vector<Command> waiting_;
  std::vector<TimedCommand> commanded_;
  std::int64_t now_ns_ = 0, busy_until_ns_ = INT64_MIN;
  std::size_t times_lost_ = 0;
  double lost_s_ = 0;
};

}  // namespace zonepack::localize
