// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/report/svg.hpp"

// A map seen from above: zones, portals, signatures and routes in metres of the map frame, drawn to
// one scale. A map much taller than wide is turned by a quarter (page right = +y, page down = +x),
// but not for a phone, which is itself taller than wide; the axes say so.
namespace zonepack::report {

struct PlanZone {
  std::string name;
  std::string note;  // second line of the label, where it fits; may be empty
  std::string hint;  // shown while the mouse is over the zone
  Polygon polygon;
  Color fill = kWhite;
};

// A picture of what is free and what is occupied, with everything else transparent: drawn over the
// fill of the zones and under all lines.
struct PlanRaster {
  std::string png;  // the file; its top row is at area.max.y_m
  Box2 area;        // outer edges of the picture, metres
};

// Something wrong with the drawing of the zones, shown in red where it is. Faults with a place of
// their own are numbered.
struct PlanFault {
  std::string number;  // "3", as in a list below the plan; may be empty
  std::string hint;
  std::vector<Ring> areas;  // overlapping or faulty outlines
  std::vector<Segment2> lines;
  std::vector<Point2> points;
};

// A signature in no zone.
struct PlanOrphan {
  Point2 p_map;
  std::string hint;
};

struct PlanRoutePoint {
  Point2 p_map;
  Color color;
};

// A place that was found at a moment of the run.
struct PlanDot {
  Point2 p_map;
  double t_s = 0;    // since the start of the run
  std::string hint;  // shown while the mouse is over it
};

// Places of one kind; the legend names the kind and counts them.
struct PlanDots {
  std::string name;
  Color color;
  bool ring = false;  // drawn around the dots of other layers instead of over them
  std::vector<PlanDot> dots;
};

// What the colour of the zones means.
struct PlanRamp {
  std::string low, high;
};

struct FloorPlan {
  std::vector<PlanZone> zones;
  std::vector<Segment2> portals;
  std::vector<Point2> signatures;
  std::optional<PlanRaster> raster;
  std::vector<PlanFault> faults;
  std::vector<PlanOrphan> orphans;
  std::vector<PlanRoutePoint> route;  // as estimated, in order
  std::vector<Point2> true_route;     // empty when unknown
  std::string true_route_name = "true route";
  std::vector<PlanDots> dots;
  std::optional<PlanRamp> ramp;
  double width_px = 900;
};

// Skips zones without a finite vertex and points that are not finite.
// The drawing says where the map lies on it, for a page's script: data-plan="a b c d e f" turns
// (x, y) of the map into (a x + c y + e, b x + d y + f) on the page.
Svg draw_floor_plan(const FloorPlan& plan);

// The same plan for a page as narrow as a phone's: never turned, as a phone is taller than wide.
FloorPlan narrowed(FloorPlan plan);

// What the page's script needs: to name zones, and to name dots.
std::string plan_json(const FloorPlan& plan);
std::string dots_json();

}  // namespace zonepack::report
