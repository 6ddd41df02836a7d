// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/matching.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "runtime/localize/features/hamming.hpp"
#include "runtime/localize/query/feature_bands.hpp"
#include "runtime/localize/query/feature_grid.hpp"
#include "runtime/localize/query/search_windows.hpp"

namespace zonepack::localize {
namespace {

// Distances of float descriptors (SIFT: 128 values up to about 180, length 512) on the scale of 256
// bits, so that one set of limits serves both.
constexpr float kFloatScale = 256.0F / 700.0F;

std::uint16_t distance_of_floats(const std::uint8_t* a, const std::uint8_t* b, std::size_t bytes) {
  float sum = 0;
  for (std::size_t i = 0; i + sizeof(float) <= bytes; i += sizeof(float)) {
    float x = 0, y = 0;
    std::memcpy(&x, a + i, sizeof x);
    std::memcpy(&y, b + i, sizeof y);
    sum += (x - y) * (x - y);
  }
  const float distance = std::sqrt(sum) * kFloatScale * 16;  // 16 steps a bit
  return static_cast<std::uint16_t>(std::min(distance, 65'000.0F));
}

// Distances of one descriptor to rows of others, in steps of which `unit` make one of 256 bits.
struct Metric {
  bool binary;
  std::size_t bytes;
  double unit() const { return binary ? static_cast<double>(bytes) / 32 : 16; }
  void rows(const std::uint8_t* one, const std::uint8_t* rows, std::size_t count,
            std::uint16_t* out) const {
    if (binary) return hamming_rows(one, rows, count, bytes, out);
    for (std::size_t i = 0; i < count; ++i)
      out[i] = distance_of_floats(one, rows + i * bytes, bytes);
  }
  std::uint16_t one(const std::uint8_t* a, const std::uint8_t* b) const {
    std::uint16_t out = 0;
    rows(a, b, 1, &out);
    return out;
  }
};

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

struct Best {
  std::uint32_t index = kNone;
  std::uint16_t first = 0xFFFF, second = 0xFFFF;
  void offer(std::uint32_t candidate, std::uint16_t distance) {
    if (distance < first) {
      second = first;
      first = distance;
      index = candidate;
    } else if (distance < second) {
      second = distance;
    }
  }
};

Sighting sighting_of(const ImageFeatures& image, const MapFeatures& map, std::uint32_t feature,
                     std::uint32_t signature, std::uint32_t row, double distance) {
  return {map.T_map_base * point_of(map.points[row]).cast<double>(),
          image.px[feature].cast<double>(),
          feature,
          weight_of_match(distance),
          signature,
          row};
}

void sort_by_feature(std::vector<Sighting>& sightings) {
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.feature < b.feature; });
}

// Calls fn(candidate, row, where in the image) for all points that a camera at the pose sees.
template <typename Fn>
void for_each_seen(std::span<const Candidate> candidates, const CameraModel& camera,
                   const Eigen::Isometry3d& T_map_base, float margin_px, Fn&& fn) {
  const Pinhole pinhole(camera);
  const Eigen::Isometry3d T_camera_map = (T_map_base * camera.T_base_camera).inverse();
  for (std::uint32_t s = 0; s < candidates.size(); ++s) {
    const MapFeatures& map = *candidates[s].map;
    const Eigen::Isometry3f T = (T_camera_map * map.T_map_base).cast<float>();
    const Eigen::Matrix3f rotation = T.linear();
    const Eigen::Vector3f shift = T.translation();
    for (std::uint32_t row = 0; row < map.points.size(); ++row) {
      const Eigen::Vector3f p = rotation * point_of(map.points[row]) + shift;
      if (p.z() < 0.2F) continue;
      const Eigen::Vector2f at = pinhole.project(p);
      if (at.x() < -margin_px || at.y() < -margin_px || at.x() > pinhole.width + margin_px ||
          at.y() > pinhole.height + margin_px) {
        continue;
      }
      fn(s, row, at);
    }
  }
}

}  // namespace

double weight_of_match(double distance) noexcept {
  return std::clamp((85 - distance) / (85 - 30), 0.05, 1.0);
}

std::vector<Sighting> match_in_windows(const ImageFeatures& image,
                                       std::span<const Candidate> candidates,
                                       const CameraModel& camera, const QueryPrior& prior,
                                       double floor_z_m, const MatchOptions& options) {
  const Metric metric{options.binary, image.descriptor_bytes};
  const double most = options.most_distance * metric.unit();
  SearchWindows windows(camera, prior, floor_z_m, options);
  FeatureBands bands(image);
  std::vector<Best> of_feature(image.size());
  std::vector<Best> of_row;
  std::vector<Sighting> out;
  for (std::uint32_t s = 0; s < candidates.size(); ++s) {
    const MapFeatures& map = *candidates[s].map;
    windows.use(map);
    std::fill(of_feature.begin(), of_feature.end(), Best{});
    of_row.assign(map.points.size(), Best{});
    for (std::uint32_t row = 0; row < map.points.size(); ++row) {
      SearchWindows::Window window;
      if (!windows.find(point_of(map.points[row]), window)) continue;
      const std::uint8_t* const descriptor = map.descriptors.data() + row * metric.bytes;
      bands.for_each_inside(
          window,
          [&](const std::uint8_t* rows, std::size_t count, std::uint16_t* distances) {
            metric.rows(descriptor, rows, count, distances);
          },
          [&](std::uint32_t feature, std::uint16_t distance) {
            of_row[row].offer(feature, distance);
            of_feature[feature].offer(row, distance);
          });
    }
    for (std::uint32_t row = 0; row < of_row.size(); ++row) {
      const Best& best = of_row[row];
      if (best.index == kNone || best.first > most) continue;
      if (best.first > options.ratio * best.second || of_feature[best.index].index != row) continue;
      out.push_back(sighting_of(image, map, best.index, s, row, best.first / metric.unit()));
    }
  }
  sort_by_feature(out);
  return out;
}

std::vector<Sighting> match_projected(const ImageFeatures& image,
                                      std::span<const Candidate> candidates,
                                      const CameraModel& camera,
                                      const Eigen::Isometry3d& T_map_base, double radius_px,
                                      const MatchOptions& options) {
  const Metric metric{options.binary, image.descriptor_bytes};
  const double most = options.most_distance * metric.unit();
  const FeatureGrid grid(image);
  std::vector<Best> of_feature(image.size());
  std::vector<std::uint32_t> touched;
  std::vector<Sighting> out;
  std::uint32_t signature = kNone;
  const auto close = [&] {
    for (const std::uint32_t feature : touched) {
      out.push_back(sighting_of(image, *candidates[signature].map, feature, signature,
                                of_feature[feature].index,
                                of_feature[feature].first / metric.unit()));
      of_feature[feature] = Best{};
    }
    touched.clear();
  };
  const auto radius = static_cast<float>(radius_px);
  for_each_seen(candidates, camera, T_map_base, radius,
                [&](std::uint32_t s, std::uint32_t row, const Eigen::Vector2f& at) {
                  if (s != signature) close();
                  signature = s;
                  const MapFeatures& map = *candidates[s].map;
                  Best best;
                  grid.for_each_near(at.x(), at.y(), radius, [&](std::uint32_t feature) {
                    best.offer(feature, metric.one(map.descriptors.data() + row * metric.bytes,
                                                   image.descriptor(feature)));
                  });
                  if (best.index == kNone || best.first > most) return;
                  Best& held = of_feature[best.index];
                  if (held.index == kNone) touched.push_back(best.index);
                  held.offer(row, best.first);
                });
  close();
  sort_by_feature(out);
  return out;
}

std::vector<Sighting> match_everywhere(const ImageFeatures& image, const MapFeatures& map,
                                       const MatchOptions& options) {
  const Metric metric{options.binary, image.descriptor_bytes};
  const double most = options.most_distance * metric.unit();
  std::vector<std::uint16_t> distances(image.size());
  std::vector<Best> of_feature(image.size());
  std::vector<Best> of_row(map.points.size());
  for (std::uint32_t row = 0; row < map.points.size(); ++row) {
    metric.rows(map.descriptors.data() + row * metric.bytes, image.descriptors.data(), image.size(),
                distances.data());
    for (std::uint32_t i = 0; i < image.size(); ++i) {
      of_row[row].offer(i, distances[i]);
      of_feature[i].offer(row, distances[i]);
    }
  }
  std::vector<Sighting> out;
  for (std::uint32_t row = 0; row < of_row.size(); ++row) {
    const Best& best = of_row[row];
    if (best.index == kNone || best.first > most) continue;
    if (best.first > options.ratio * best.second || of_feature[best.index].index != row) continue;
    out.push_back(sighting_of(image, map, best.index, 0, row, best.first / metric.unit()));
  }
  sort_by_feature(out);
  return out;
}

int count_visible(const ImageFeatures& image, std::span<const Candidate> candidates,
                  const CameraModel& camera, const Eigen::Isometry3d& T_map_base, double radius_px,
                  std::optional<double> most_change) {
  const FeatureGrid grid(image);
  const Eigen::Vector3d eye = T_map_base * camera.T_base_camera.translation();
  std::vector<bool> seen(image.size());
  const auto radius = static_cast<float>(radius_px);
  for_each_seen(candidates, camera, T_map_base, radius,
                [&](std::uint32_t s, std::uint32_t row, const Eigen::Vector2f& at) {
                  if (most_change) {
                    const MapFeatures& map = *candidates[s].map;
                    const Eigen::Vector3d p_map =
                        map.T_map_base * point_of(map.points[row]).cast<double>();
                    if (!(view_change(map, p_map, eye) <= *most_change)) return;
                  }
                  grid.for_each_near(at.x(), at.y(), radius,
                                     [&](std::uint32_t feature) { seen[feature] = true; });
                });
  return static_cast<int>(std::count(seen.begin(), seen.end(), true));
}

}  // namespace zonepack::localize
