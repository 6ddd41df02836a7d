// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/stella_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace zonepack::packer {

const std::array<double, 3>* StellaMap::landmark(std::int32_t id) const {
  const auto found = std::ranges::lower_bound(landmark_ids, id);
  if (found == landmark_ids.end() || *found != id) return nullptr;
  return &landmarks[static_cast<std::size_t>(found - landmark_ids.begin())];
}

const StellaKeyframe* StellaMap::find(std::int32_t id) const {
  const auto found = std::ranges::lower_bound(keyframes, id, {}, &StellaKeyframe::id);
  return found != keyframes.end() && found->id == id ? &*found : nullptr;
}

OrbParameters StellaMap::orb_of(const StellaKeyframe& keyframe) const {
  const auto found = orb.find(keyframe.orb);
  return found == orb.end() ? OrbParameters() : found->second;
}

float keypoint_size(const OrbParameters& orb, std::int32_t octave) {
  constexpr double kPatch_px = 31;
  double size = kPatch_px;
  for (std::int32_t i = 0; i < std::min(octave, 64); ++i) size *= orb.scale_factor;
  return static_cast<float>(size);
}

void sort_by_id(StellaMap& map, const std::string& file) {
  std::ranges::stable_sort(map.keyframes, {}, &StellaKeyframe::id);
  const auto twice = std::ranges::adjacent_find(map.keyframes, {}, &StellaKeyframe::id);
  if (twice != map.keyframes.end()) {
    throw std::runtime_error(file + ": holds keyframe " + std::to_string(twice->id) +
                             " twice; save the map again");
  }
  std::vector<std::size_t> order(map.landmark_ids.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&map](std::size_t i) { return map.landmark_ids[i]; });
  std::vector<std::int32_t> ids;
  std::vector<std::array<double, 3>> places;
  ids.reserve(order.size());
  places.reserve(order.size());
  for (const std::size_t i : order) {
    if (!ids.empty() && ids.back() == map.landmark_ids[i]) {
      throw std::runtime_error(file + ": holds landmark " + std::to_string(ids.back()) +
                               " twice; save the map again");
    }
    ids.push_back(map.landmark_ids[i]);
    places.push_back(map.landmarks[i]);
  }
  map.landmark_ids = std::move(ids);
  map.landmarks = std::move(places);
}

void require_camera_pose(const Eigen::Isometry3d& T, const CellPlace& place) {
  constexpr double kFurthest = 1e7;
  constexpr double kTolerance = 0.01;
  const Eigen::Matrix3d R = T.linear();
  const bool rotation =
      R.allFinite() && R.determinant() > 0 &&
      (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kTolerance;
  if (!rotation) place.damaged("expected a rotation, found none");
  if (!T.translation().allFinite() || T.translation().cwiseAbs().maxCoeff() >= kFurthest) {
    place.damaged("expected a place within 10,000,000 units");
  }
}

}  // namespace zonepack::packer
