// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/findings.hpp"

#include <cstdio>

namespace zonepack::packer {

std::optional<Point2> point_of(const FindingPlace& place) {
  if (!place.points.empty()) return place.points.front();
  if (!place.lines.empty()) {
    const auto& [p, q] = place.lines.front();
    return Point2{(p.x_m + q.x_m) / 2, (p.y_m + q.y_m) / 2};
  }
  if (place.areas.empty() || place.areas.front().empty()) return std::nullopt;
  Point2 sum;
  for (const Point2& p : place.areas.front()) sum = {sum.x_m + p.x_m, sum.y_m + p.y_m};
  const auto count = static_cast<double>(place.areas.front().size());
  return Point2{sum.x_m / count, sum.y_m / count};
}

std::string to_string(const Finding& finding, const std::string& file) {
  std::string text = file;
  if (finding.line != 0) text += ":" + std::to_string(finding.line);
  return text + ": " + finding.message;
}

std::string describe_faults(const Findings& findings, const std::string& file) {
  const std::size_t count = findings.faults.size();
  std::string text = file + ": " + std::to_string(count) + (count == 1 ? " fault" : " faults") +
                     " in the zone file";
  for (const Finding& fault : findings.faults) text += "\n  " + to_string(fault, file);
  if (findings.faults.left_out() > 0) {
    text += "\n  and " + std::to_string(findings.faults.left_out()) + " more";
  }
  return text;
}

std::string number_text(double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.3f", value);
  std::string text = buffer;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string point_text(Point2 point) {
  return "(" + number_text(point.x_m) + ", " + number_text(point.y_m) + ")";
}

}  // namespace zonepack::packer
