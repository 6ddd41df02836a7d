// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/second_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/localize/features/hamming.hpp"

namespace zonepack::localize {
namespace {

constexpr std::size_t kMostSignatures = 12, kMostPlaces = 60, kMostPointsAPlace = 4;
constexpr double kMostChange = 0.5;  // view_change()
constexpr double kApart_px = 6;      // points nearer to each other are one place
constexpr double kNearMatch_px = 8;  // and near a match there is nothing new
constexpr int kClearly_bits = 20;
constexpr int kSomething_bits = 5;       // less between all of them: there is nothing to see
constexpr std::size_t kLeastAround = 4;  // of the places around one, inside the image

struct Shift {
  float x, y;
};
// The place itself first. Far enough to show something else, near enough to be of the same floor or
// wall.
constexpr std::array<Shift, 9> kPlaces{
    {{0, 0}, {23, 9}, {-9, 23}, {-23, -9}, {9, -23}, {41, -17}, {17, 41}, {-41, 17}, {-17, -41}}};
// What a pose is off by, and what a descriptor bears.
constexpr std::array<Shift, 5> kSteps{{{0, 0}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}}};

struct MapPointSeen {
  Eigen::Vector2f px;  // as an ideal pinhole camera sees it
  const std::uint8_t* descriptor;
  double change;
};

std::vector<MapPointSeen> points_in_view(std::span<const Candidate> candidates,
                                         const CameraModel& camera,
                                         const Eigen::Isometry3d& T_map_base) {
  const Eigen::Isometry3d T_map_camera = T_map_base * camera.T_base_camera;
  const Eigen::Isometry3d T_camera_map = T_map_camera.inverse();
  std::vector<MapPointSeen> out;
  for (const Candidate& candidate :
       candidates.first(std::min(kMostSignatures, candidates.size()))) {
    const MapFeatures& map = *candidate.map;
    for (std::size_t row = 0; row < map.points.size(); ++row) {
      const MapPoint& point = map.points[row];
      const Eigen::Vector3d p_map =
          map.T_map_base * Eigen::Vector3d(point.x_m, point.y_m, point.z_m);
      const Eigen::Vector3d p_camera = T_camera_map * p_map;
      if (p_camera.z() < kLeastDepth) continue;
      const Eigen::Vector2d px(camera.cx + camera.fx * p_camera.x() / p_camera.z(),
                               camera.cy + camera.fy * p_camera.y() / p_camera.z());
      if (px.x() < 0 || px.y() < 0 || px.x() > camera.width || px.y() > camera.height) continue;
      const double change = view_change(map, p_map, T_map_camera.translation());
      if (!(change <= kMostChange)) continue;
      out.push_back(
          {px.cast<float>(), map.descriptors.data() + row * map.descriptor_bytes, change});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const MapPointSeen& a, const MapPointSeen& b) {
    return a.change < b.change;
  });
  return out;
}

struct Place {
  Eigen::Vector2f px;
  std::vector<const std::uint8_t*> descriptors;  // of the map's points there
};

std::vector<Place> places_of(const std::vector<MapPointSeen>& points,
                             std::span<const Sighting> matched, double scale) {
  const auto apart2 = static_cast<float>(std::pow(kApart_px * scale, 2));
  const auto matched2 = static_cast<float>(std::pow(kNearMatch_px * scale, 2));
  std::vector<Place> out;
  for (const MapPointSeen& point : points) {
    const auto near_match = [&](const Sighting& sighting) {
      return (sighting.px.cast<float>() - point.px).squaredNorm() < matched2;
    };
    if (std::any_of(matched.begin(), matched.end(), near_match)) continue;
    const auto same = std::find_if(out.begin(), out.end(), [&](const Place& place) {
      return (place.px - point.px).squaredNorm() < apart2;
    });
    if (same == out.end()) {
      if (out.size() < kMostPlaces) out.push_back({point.px, {point.descriptor}});
    } else if (same->descriptors.size() < kMostPointsAPlace) {
      same->descriptors.push_back(point.descriptor);
    }
  }
  return out;
}

// Of the map's points at a place to what is seen there: at kSteps from the number `first` of a
// list. None outside the image.
std::optional<int> least_distance(const Place& place, const DescribedPlaces& described,
                                  std::size_t first, std::uint32_t bytes) {
  std::optional<int> least;
  for (std::size_t s = 0; s < kSteps.size(); ++s) {
    const std::uint8_t* seen = described.find(first + s);
    if (seen == nullptr) continue;
    for (const std::uint8_t* descriptor : place.descriptors) {
      std::uint16_t distance = 0;
      hamming_rows(descriptor, seen, 1, bytes, &distance);
      if (!least || distance < *least) least = distance;
    }
  }
  return least;
}

}  // namespace

SecondLook take_second_look(PlaceDescriber& describer, std::span<const Candidate> candidates,
                            const CameraModel& camera, const Eigen::Isometry3d& T_map_base,
                            std::span<const Sighting> matched) {
  const double scale = camera.fx / kUsualFocal_px;
  const std::vector<Place> places =
      places_of(points_in_view(candidates, camera, T_map_base), matched, scale);
  constexpr std::size_t kLooks = kPlaces.size() * kSteps.size();
  std::vector<Eigen::Vector2f> looks;
  looks.reserve(places.size() * kLooks);
  for (const Place& place : places) {
    const Eigen::Vector2f middle = camera.seen(place.px);
    for (const Shift& around : kPlaces) {
      for (const Shift& step : kSteps) {
        looks.emplace_back(middle.x() + around.x * static_cast<float>(scale) + step.x,
                           middle.y() + around.y * static_cast<float>(scale) + step.y);
      }
    }
  }
  const DescribedPlaces described = describer.places(looks);
  const std::uint32_t bytes = describer.descriptor_bytes();
  SecondLook out;
  for (std::size_t p = 0; p < places.size(); ++p) {
    std::vector<int> nearest;  // distance at each place that is inside the image, this one first
    for (std::size_t k = 0; k < kPlaces.size(); ++k) {
      const auto least =
          least_distance(places[p], described, p * kLooks + k * kSteps.size(), bytes);
      if (least) {
        nearest.push_back(*least);
      } else if (k == 0) {
        break;
      }
    }
    if (nearest.size() <= kLeastAround) continue;
    const auto [least, most] = std::minmax_element(nearest.begin(), nearest.end());
    if (*most - *least < kSomething_bits) continue;
    ++out.points;
    const int around = *std::min_element(nearest.begin() + 1, nearest.end());
    out.recognised += around - nearest.front() >= kClearly_bits ? 1 : 0;
  }
  return out;
}

}  // namespace zonepack::localize
