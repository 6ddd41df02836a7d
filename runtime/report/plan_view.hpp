// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/report/svg.hpp"

namespace zonepack::report {

// Maps metres of the map to the page: equal scale on both axes, with a quarter turn when the map is
// much taller than wide.
class PlanView {
 public:
  // Fits `area` into a box of this width and at most this height, with its upper left corner there.
  // Upright: without the quarter turn, for a page that is taller than wide.
  PlanView(const Box2& area, Px corner, double width, double most_height,
           bool upright = false) noexcept;

  Px operator()(Point2 p_map) const noexcept;
  std::vector<Px> operator()(const Ring& ring) const;
  std::vector<std::vector<Px>> operator()(const Polygon& polygon) const;

  bool turned() const noexcept { return turned_; }
  double px_per_m() const noexcept { return px_per_m_; }
  Px corner() const noexcept { return corner_; }
  double width() const noexcept { return width_; }
  double height() const noexcept { return height_; }
  const Box2& area() const noexcept { return area_; }

 private:
  Box2 area_;
  Px corner_;
  bool turned_;
  double px_per_m_;
  double width_;
  double height_;
};

}  // namespace zonepack::report
