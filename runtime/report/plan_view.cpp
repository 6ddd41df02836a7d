// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/plan_view.hpp"

#include <algorithm>

namespace zonepack::report {
namespace {

constexpr double kTurnAbove = 1.25;  // height over width
constexpr double kLeastSide_m = 0.5;

}  // namespace

PlanView::PlanView(const Box2& area, Px corner, double width, double most_height,
                   bool upright) noexcept
    : area_(area), corner_(corner) {
  const double east = std::max(area.max.x_m - area.min.x_m, kLeastSide_m);
  const double north = std::max(area.max.y_m - area.min.y_m, kLeastSide_m);
  turned_ = !upright && north > kTurnAbove * east;
  const double across = turned_ ? north : east;
  const double down = turned_ ? east : north;
  px_per_m_ = std::min(width / across, most_height / down);
  width_ = across * px_per_m_;
  height_ = down * px_per_m_;
}

Px PlanView::operator()(Point2 p) const noexcept {
  if (turned_) {
    return {corner_.x + (p.y_m - area_.min.y_m) * px_per_m_,
            corner_.y + (p.x_m - area_.min.x_m) * px_per_m_};
  }
  return {corner_.x + (p.x_m - area_.min.x_m) * px_per_m_,
          corner_.y + (area_.max.y_m - p.y_m) * px_per_m_};
}

std::vector<Px> PlanView::operator()(const Ring& ring) const {
  std::vector<Px> points;
  points.reserve(ring.size());
  for (const Point2& p : ring) points.push_back((*this)(p));
  return points;
}

std::vector<std::vector<Px>> PlanView::operator()(const Polygon& polygon) const {
  std::vector<std::vector<Px>> rings;
  rings.push_back((*this)(polygon.outer));
  for (const Ring& hole : polygon.holes) rings.push_back((*this)(hole));
  return rings;
}

}  // namespace zonepack::report
