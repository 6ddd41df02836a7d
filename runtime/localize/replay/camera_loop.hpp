// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/localize/replay/features_in_reach.hpp"
#include "runtime/localize/replay/lost_loop.hpp"
#include "runtime/odometry/fix_consistency.hpp"
#include "runtime/replay/fix_source.hpp"

namespace zonepack::localize {

// An image of a recorded drive. The log's clock may be set on the way: frames are on the clock of
// the first one, files keep the stamps of the log as it stands.
struct LoopImage {
  std::int64_t stamp_ns = 0;           // on the clock of the cycles
  std::int64_t recorded_stamp_ns = 0;  // as in the list of images
  std::string file;
};

// Finds the camera's pose in one image. A failure is an image that cannot be read.
using ImageFinder = std::function<Outcome<QueryResult>(
    const LoopImage& image, std::span<const MapFeatures* const> map, const QueryPrior& prior)>;

// What became of one image.
struct LoopView {
  enum class Kind : std::uint8_t {
    kQueried,
    kNoPose,      // the robot did not know where it is
    kSearching,   // it was lost, and the image a view of the search
    kUnreadable,  // no image
  };
  Kind kind = Kind::kNoPose;
  LoopImage image;
  QueryResult result;  // of kQueried; without what is for drawing
  PoseCorrection fix;  // of an accepted one, on the clock of the cycles
  int offered = 0;     // resident signatures that were in reach
};

// The camera of a replay: queries each image when its time has come, with the pose of that moment
// as the prior, against what is resident then, and hands the fix over when a localizer would have
// finished.
//
// Memory: a view for each image.
class CameraLoop final : public FixSource {
 public:
  struct Options {
    // From an image's stamp to its fix. The query is made half-way: the image has to reach the
    // localizer, and the fix the robot.
    std::int64_t latency_ns = 0;
    std::uint32_t descriptor_bytes = 0;  // of the map's features
  };
  // `images` in order of time.
  CameraLoop(std::vector<LoopImage> images, ImageFinder find, const Options& options);

  // Called after each image.
  void on_progress(std::function<void()> tell) { tell_ = std::move(tell); }

  // Called with each accepted result, with what is for drawing if the finder gave it.
  void on_fix(std::function<void(const QueryResult&)> tell) { tell_fix_ = std::move(tell); }
  // Searches the map when the robot is lost, which is noticed. Must outlive this object.
  void search_with(LostLoop& lost) { lost_ = &lost; }

  void after_cycle(const FixMoment& moment, std::vector<PoseCorrection>& fixes) override;
  void command(const FixMoment& moment, std::vector<TimedCommand>& commands) override;

  // Of the images within the run's time, in their order.
  const std::vector<LoopView>& views() const noexcept { return views_; }
  // Complete messages; the first few images that could not be read.
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  // Of all fixes against the pose that they came to.
  const FixConsistency& consistency() const noexcept { return consistency_; }
  // The most by which fixes were off what their covariance says, as a share of variance.
  double widest() const noexcept { return widest_; }
  std::int64_t start_ns() const noexcept { return start_ns_.value_or(0); }
  std::int64_t end_ns() const noexcept { return end_ns_; }
  // When the pose was trusted for the first time, and how many images had come until then.
  std::optional<std::int64_t> found_ns() const noexcept { return found_ns_; }
  std::size_t found_after_views() const noexcept { return found_after_views_; }

 private:
  void look(const LoopImage& image, const FixMoment& moment, std::vector<PoseCorrection>& fixes);
  void search(const FixMoment& moment, std::vector<PoseCorrection>& fixes);
  void refuse(LoopView& view, const std::string& why);

  std::vector<LoopImage> images_;
  ImageFinder find_;
  Options options_;
  FeaturesInReach features_;
  LostLoop* lost_ = nullptr;
  std::function<void()> tell_;
  std::function<void(const QueryResult&)> tell_fix_;
  std::size_t next_ = 0;
  std::vector<LoopView> views_;
  std::vector<std::string> warnings_;
  FixConsistency consistency_;
  double widest_ = 1;
  std::optional<std::int64_t> start_ns_, found_ns_;
  std::int64_t end_ns_ = 0;
  std::size_t found_after_views_ = 0;
};

// The pose at an image's stamp, which is before the estimate's time: carried back with its speeds.
QueryPrior prior_at(std::int64_t stamp_ns, const PoseEstimate& estimate) noexcept;

}  // namespace zonepack::localize
