// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/process/clock.hpp"
#include "runtime/localize/features/feature_detector.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/query/matching.hpp"
#include "runtime/localize/solve/refine.hpp"

// What the parts of a query share. Near a known pose: locate_near.cpp; without one:
// locate_anywhere.cpp; what an image says of a pose: explain_pose.cpp.
namespace zonepack::localize {

// Adds the processor time of this thread to the stages of a result.
class StageClock {
 public:
  explicit StageClock(QueryResult& result) : result_(result), last_(thread_cpu_ns()) {}
  void end(Stage stage) {
    const std::int64_t now = thread_cpu_ns();
    result_.cpu_ns[static_cast<std::size_t>(stage)] += now - last_;
    result_.cpu_total_ns += now - last_;
    last_ = now;
  }

 private:
  QueryResult& result_;
  std::int64_t last_;
};

struct Localizer::State {
  CameraModel camera;
  FeatureDetector detector;
  QueryOptions options;
  double scale;  // of distances in pixels

  // `pixels`: of the image, for finding places and for a second look; may be null.
  void locate_near(const ImageFeatures& image, const GreyImage* pixels,
                   std::span<const MapFeatures* const> map, const QueryPrior& prior,
                   QueryResult& result);
  void locate_anywhere(const ImageFeatures& image, std::span<const MapFeatures* const> map,
                       QueryResult& result);
  // `describer`: of the image, for a second look; may be null.
  void solve(const ImageFeatures& image, PlaceDescriber* describer, const Candidates& candidates,
             const std::vector<Sighting>& sightings, const QueryPrior& prior, QueryResult& result);
  void polish(const ImageFeatures& image, const Candidates& candidates,
              const Eigen::Isometry3d& start, QueryResult& result) const;
  void count(const ImageFeatures& image, const Candidates& candidates,
             std::vector<Sighting>& sightings, const Eigen::Isometry3d& T_map_base,
             QueryResult& result) const;
  int count_expected(const ImageFeatures& image, const Candidates& candidates,
                     const Eigen::Isometry3d& T_map_base) const;
  void weigh_second_look(const ImageFeatures& image, PlaceDescriber& describer,
                         const Candidates& candidates, QueryResult& result);
  void judge(const Candidates& candidates, const QueryPrior& prior, QueryResult& result) const;
  // The pose near `start` that explains the sightings best, on the floor of the candidates. The
  // scales of the loss are for the usual focal length.
  Refined refine_on_floor(std::span<const Sighting> sightings, const Candidates& candidates,
                          const Eigen::Isometry3d& start, double start_px, double end_px) const {
    PlanePrior plane;
    plane.floor_z_m = candidates.floor_z_m;
    RefineOptions refining;
    refining.start_px = start_px * scale;
    refining.end_px = end_px * scale;
    refining.sigma_px = scale;
    return refine(sightings, camera, start, plane, refining);
  }
  MatchOptions matching() const {
    MatchOptions out;
    out.binary = detector.settings().binary();
    out.margin_px *= scale;
    return out;
  }
};

}  // namespace zonepack::localize
