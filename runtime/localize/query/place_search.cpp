// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "runtime/localize/features/hamming.hpp"
#include "runtime/localize/query/search_windows.hpp"

namespace zonepack::localize {
namespace {

constexpr int kLeastStep_px = 4;      // a descriptor bears to be off by half of it
constexpr double kMostGrid = 20'000;  // places that are described, about
constexpr std::size_t kMostSought = 120, kMostPointsSought = 3;
constexpr double kMostChangeSought = 0.8;  // view_change()
constexpr double kSoughtApart_px = 6;      // points nearer to each other are one place
constexpr double kMostDistanceFound = 75;  // between descriptors, of 256 bits
constexpr double kRatioFound = 0.85;       // to the nearest one that is
constexpr double kBeside_px = 10;          // farther away than this
constexpr std::size_t kLeastInside = 9;    // of the pixels described in a window

struct SoughtPoint {
  SearchWindows::Window window;
  std::uint32_t signature, row;
  double change;
};

// Points at about the same place of the image, in the window of the first.
struct SoughtPlace {
  SearchWindows::Window window;
  std::vector<const SoughtPoint*> points;
};

std::vector<SoughtPoint> points_sought(const Candidates& candidates, const CameraModel& camera,
                                       const QueryPrior& prior, const MatchOptions& options) {
  SearchWindows windows(camera, prior, candidates.floor_z_m, options);
  const Eigen::Vector3d eye =
      lift(prior.T_map_base, candidates.floor_z_m) * camera.T_base_camera.translation();
  std::vector<SoughtPoint> out;
  for (std::uint32_t s = 0; s < candidates.best.size(); ++s) {
    const MapFeatures& map = *candidates.best[s].map;
    windows.use(map);
    for (std::uint32_t row = 0; row < map.points.size(); ++row) {
      const Eigen::Vector3f p_base = point_of(map.points[row]);
      SoughtPoint point{{}, s, row, 0};
      if (!windows.find(p_base, point.window)) continue;
      point.change = view_change(map, map.T_map_base * p_base.cast<double>(), eye);
      if (point.change <= kMostChangeSought) out.push_back(point);
    }
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const SoughtPoint& a, const SoughtPoint& b) { return a.change < b.change; });
  return out;
}

std::vector<SoughtPlace> places_sought(const std::vector<SoughtPoint>& points, double scale) {
  const auto apart2 = static_cast<float>(std::pow(kSoughtApart_px * scale, 2));
  std::vector<SoughtPlace> out;
  for (const SoughtPoint& point : points) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const SoughtPlace& place) {
      return (place.window.middle - point.window.middle).squaredNorm() < apart2;
    });
    if (same == out.end()) {
      if (out.size() < kMostSought) out.push_back({point.window, {&point}});
    } else if (same->points.size() < kMostPointsSought) {
      same->points.push_back(&point);
    }
  }
  return out;
}

int step_of(const GreyImage& pixels) {
  const double each = static_cast<double>(pixels.pixels.size()) / kMostGrid;
  return std::max(kLeastStep_px, static_cast<int>(std::ceil(std::sqrt(each))));
}

// The image at every fourth pixel, row by row, and where in it a point is.
class DescribedImage {
 public:
  DescribedImage(PlaceDescriber& describer, const CameraModel& camera)
      : beside2_(static_cast<float>(std::pow(kBeside_px * camera.fx / kUsualFocal_px, 2))),
        grid_(describer.grid(step_of(describer.image()))) {
    for (int row = 0; row < grid_.rows; ++row) {
      Row line{static_cast<std::uint32_t>(px_.size()), 0, 1e9F, -1e9F};
      for (int column = 0; column < grid_.columns; ++column) {
        px_.push_back(camera.ideal(seen_px(px_.size())));
        line.least_y = std::min(line.least_y, px_.back().y());
        line.most_y = std::max(line.most_y, px_.back().y());
      }
      line.end = static_cast<std::uint32_t>(px_.size());
      rows_.push_back(line);
    }
    least_.resize(px_.size());
  }

  struct Found {
    Eigen::Vector2f seen_px;
    const SoughtPoint* point;
  };
  std::optional<Found> find(const SoughtPlace& place, const Candidates& candidates) {
    find_inside(place.window);
    std::uint32_t best = 0;
    std::uint16_t least = 0xFFFF;
    std::size_t inside = 0;
    for (const Run& run : runs_) {
      inside += run.end - run.first;
      compare(place, run, candidates);
      const auto from = least_.begin() + run.first, to = least_.begin() + run.end;
      const std::uint16_t here = std::accumulate(from, to, std::uint16_t{0xFFFF},
                                                 [](auto a, auto b) { return std::min(a, b); });
      if (here >= least) continue;
      least = here;
      best = static_cast<std::uint32_t>(std::find(from, to, here) - least_.begin());
    }
    const double unit = static_cast<double>(grid_.descriptor_bytes) / 32;
    if (inside < kLeastInside || least > kMostDistanceFound * unit) return std::nullopt;
    std::uint16_t second = 0xFFFF;
    for (const Run& run : runs_) {
      for (std::uint32_t i = run.first; i < run.end; ++i) {
        if (least_[i] < second && (px_[i] - px_[best]).squaredNorm() > beside2_) second = least_[i];
      }
    }
    if (second == 0xFFFF || least > kRatioFound * second) return std::nullopt;
    for (const SoughtPoint* point : place.points) {
      compare({best, best + 1}, *point, candidates, &second);
      if (second == least) return Found{seen_px(best), point};
    }
    return std::nullopt;
  }

 private:
  struct Run {
    std::uint32_t first, end;
  };
  struct Row {
    std::uint32_t first, end;
    float least_y, most_y;
  };

  // Of a place of the grid, in the image.
  Eigen::Vector2f seen_px(std::size_t place) const {
    const int number = static_cast<int>(place);
    const int row = number / grid_.columns, column = number % grid_.columns;
    return {static_cast<float>(grid_.first_px + column * grid_.step_px),
            static_cast<float>(grid_.first_px + row * grid_.step_px)};
  }

  // What is described of a window: one run of each row that it touches.
  void find_inside(const SearchWindows::Window& window) {
    const Eigen::Vector2f from = window.middle - window.half, to = window.middle + window.half;
    runs_.clear();
    for (const Row& row : rows_) {
      if (row.most_y < from.y() || row.least_y > to.y()) continue;
      const auto begin = px_.begin() + row.first, end = px_.begin() + row.end;
      const auto first = std::partition_point(
          begin, end, [&](const Eigen::Vector2f& px) { return px.x() < from.x(); });
      const auto last = std::partition_point(
          first, end, [&](const Eigen::Vector2f& px) { return px.x() <= to.x(); });
      if (first == last) continue;
      runs_.push_back({static_cast<std::uint32_t>(first - px_.begin()),
                       static_cast<std::uint32_t>(last - px_.begin())});
    }
  }

  // How far what is seen there is from the nearest of a place's points.
  void compare(const SoughtPlace& place, const Run& run, const Candidates& candidates) {
    std::uint16_t* const least = least_.data() + run.first;
    const std::size_t count = run.end - run.first;
    compare(run, *place.points.front(), candidates, least);
    for (std::size_t p = 1; p < place.points.size(); ++p) {
      distances_.resize(std::max(distances_.size(), count));
      compare(run, *place.points[p], candidates, distances_.data());
      for (std::size_t i = 0; i < count; ++i) least[i] = std::min(least[i], distances_[i]);
    }
  }
  void compare(const Run& run, const SoughtPoint& point, const Candidates& candidates,
               std::uint16_t* out) const {
    const std::size_t bytes = grid_.descriptor_bytes;
    hamming_rows(candidates.best[point.signature].map->descriptors.data() + point.row * bytes,
                 grid_.descriptors.data() + run.first * bytes, run.end - run.first, bytes, out);
  }

  float beside2_;
  DescribedGrid grid_;
  std::vector<Eigen::Vector2f> px_;  // as an ideal pinhole camera would see them
  std::vector<Row> rows_;
  // Of the place that is looked for.
  std::vector<Run> runs_;
  std::vector<std::uint16_t> distances_, least_;
};

// Of the pixels around what was found, between the places of the grid, those that look most like
// the points: they become features of the image, and matches.
std::vector<Sighting> look_closer(PlaceDescriber& describer,
                                  const std::vector<DescribedImage::Found>& found,
                                  const Candidates& candidates, const CameraModel& camera,
                                  ImageFeatures& image) {
  const auto reach = static_cast<float>(step_of(describer.image()) / 2);
  std::vector<Eigen::Vector2f> around;
  for (const DescribedImage::Found& one : found) {
    for (float x = -reach; x <= reach; ++x) {
      for (float y = -reach; y <= reach; ++y) around.push_back(one.seen_px + Eigen::Vector2f(x, y));
    }
  }
  const DescribedPlaces near = describer.places(around);
  const std::size_t each = around.size() / std::max<std::size_t>(1, found.size());
  const std::size_t bytes = near.descriptor_bytes;
  std::vector<Sighting> out;
  for (std::size_t f = 0; f < found.size(); ++f) {
    const SoughtPoint& point = *found[f].point;
    const MapFeatures& map = *candidates.best[point.signature].map;
    std::size_t best = 0;
    std::uint16_t least = 0xFFFF;
    for (std::size_t k = f * each; k < (f + 1) * each; ++k) {
      const std::uint8_t* row = near.find(k);
      if (row == nullptr) continue;
      std::uint16_t distance = 0;
      hamming_rows(map.descriptors.data() + point.row * bytes, row, 1, bytes, &distance);
      if (distance < least) least = distance, best = k;
    }
    const auto feature = static_cast<std::uint32_t>(image.size());
    image.seen_px.push_back(around[best]);
    image.px.push_back(camera.ideal(around[best]));
    image.descriptors.insert(image.descriptors.end(), near.find(best), near.find(best) + bytes);
    const double distance = least / (static_cast<double>(bytes) / 32);
    out.push_back({map.T_map_base * point_of(map.points[point.row]).cast<double>(),
                   image.px.back().cast<double>(), feature, weight_of_match(distance),
                   point.signature, point.row});
  }
  return out;
}

}  // namespace

std::vector<Sighting> find_places(PlaceDescriber& describer, const Candidates& candidates,
                                  const CameraModel& camera, const QueryPrior& prior,
                                  const MatchOptions& options, ImageFeatures& image) {
  const std::vector<SoughtPoint> points = points_sought(candidates, camera, prior, options);
  std::vector<DescribedImage::Found> found;
  {
    DescribedImage described(describer, camera);
    for (const SoughtPlace& place : places_sought(points, camera.fx / kUsualFocal_px)) {
      if (const auto one = described.find(place, candidates)) found.push_back(*one);
    }
  }
  return look_closer(describer, found, candidates, camera, image);
}

}  // namespace zonepack::localize
