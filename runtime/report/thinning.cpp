// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace zonepack::report {
namespace {

constexpr int kMostDoublings = 40;

bool is_known(const Waypoint& p) noexcept { return std::isfinite(p.value[0]); }

// The directions from a corner in which a line meets all points since, within the tolerance.
class Door {
 public:
  Door(const Waypoint& corner, const std::array<double, 3>& tolerance)
      : corner_(corner), tolerance_(tolerance) {
    low_.fill(-std::numeric_limits<double>::infinity());
    high_.fill(std::numeric_limits<double>::infinity());
  }

  bool holds(const Waypoint& p) const noexcept {
    const double dt = p.t_s - corner_.t_s;
    if (!(dt > 0)) return false;
    for (std::size_t i = 0; i < low_.size(); ++i) {
      const double slope = (p.value[i] - corner_.value[i]) / dt;
      if (!(slope >= low_[i] && slope <= high_[i])) return false;
    }
    return true;
  }

  void narrow(const Waypoint& p) noexcept {
    const double dt = p.t_s - corner_.t_s;
    if (!(dt > 0)) return;
    for (std::size_t i = 0; i < low_.size(); ++i) {
      const double rise = p.value[i] - corner_.value[i];
      low_[i] = std::max(low_[i], (rise - tolerance_[i]) / dt);
      high_[i] = std::min(high_[i], (rise + tolerance_[i]) / dt);
    }
  }

 private:
  Waypoint corner_;
  std::array<double, 3> tolerance_, low_{}, high_{};
};

std::vector<std::size_t> corners_once(std::span<const Waypoint> points,
                                      const std::array<double, 3>& tolerance) {
  std::vector<std::size_t> kept;
  if (points.empty()) return kept;
  const auto keep = [&kept](std::size_t i) {
    if (kept.empty() || kept.back() != i) kept.push_back(i);
  };
  keep(0);
  Door door(points[0], tolerance);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (is_known(points[i]) != is_known(points[i - 1])) {
      keep(i - 1);
      keep(i);
      door = Door(points[i], tolerance);
    } else if (is_known(points[i])) {
      if (!door.holds(points[i])) {
        keep(i - 1);
        door = Door(points[i - 1], tolerance);
      }
      door.narrow(points[i]);
    }
  }
  keep(points.size() - 1);
  return kept;
}

}  // namespace

std::vector<std::size_t> corners_of(std::span<const Waypoint> points,
                                    std::array<double, 3> tolerance, std::size_t most) {
  std::vector<std::size_t> kept = corners_once(points, tolerance);
  for (int i = 0; i < kMostDoublings && kept.size() > most; ++i) {
    for (double& value : tolerance) value *= 2;
    kept = corners_once(points, tolerance);
  }
  if (kept.size() <= most || most == 0) return kept;
  const std::size_t stride = (kept.size() + most - 1) / most;
  std::vector<std::size_t> fewer;
  for (std::size_t i = 0; i < kept.size(); i += stride) fewer.push_back(kept[i]);
  return fewer;
}

std::vector<Sample> changes_of(std::span<const Sample> samples, std::size_t most) {
  const auto same = [](double a, double b) {
    return a == b || (!std::isfinite(a) && !std::isfinite(b));
  };
  std::vector<Sample> changes;
  for (const Sample& sample : samples) {
    if (changes.empty() || !same(changes.back().value, sample.value)) changes.push_back(sample);
  }
  if (changes.size() <= most || most == 0) return changes;
  const std::size_t stride = (changes.size() + most - 1) / most;
  std::vector<Sample> fewer;
  for (std::size_t i = 0; i < changes.size(); i += stride) {
    const std::span<const Sample> group =
        std::span(changes).subspan(i, std::min(stride, changes.size() - i));
    fewer.push_back(
        {group.front().t_s, std::ranges::max_element(group, {}, &Sample::value)->value});
  }
  return fewer;
}

}  // namespace zonepack::report
