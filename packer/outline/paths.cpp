// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/paths.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;

constexpr double kJump_m = 1.0;
constexpr double kJumpShare = 0.1;
constexpr double kJumpWithoutOdometry_m = 10.0;

double distance_m(const Transform& a, const Transform& b) {
  const double dx = a[3] - b[3], dy = a[7] - b[7], dz = a[11] - b[11];
  return std::sqrt(dx * dx + dy * dy + dz * dz);
}

bool jumps(const NodeOutline& a, const NodeOutline& b) {
  const double moved = distance_m(*a.pose, *b.pose);
  if (!a.odometry_pose || !b.odometry_pose) return moved > kJumpWithoutOdometry_m;
  const double odometry = distance_m(*a.odometry_pose, *b.odometry_pose);
  return std::abs(moved - odometry) > kJump_m + kJumpShare * odometry;
}

// Keeps few digits: `per_unit` of 100 keeps hundredths.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

ordered_json position(const Transform& pose) {
  return {rounded(pose[3], 1e4), rounded(pose[7], 1e4)};
}

std::string collection(const std::string& name, const std::vector<ordered_json>& features) {
  const ordered_json crs = {{"type", "name"},
                            {"properties", {{"name", "urn:ogc:def:crs:EPSG::3857"}}}};
  std::string text = "{\n\"type\": \"FeatureCollection\",\n\"name\": \"" + name +
                     "\",\n\"crs\": " + crs.dump() + ",\n\"features\": [\n";
  for (std::size_t i = 0; i < features.size(); ++i) {
    text += features[i].dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    text += i + 1 < features.size() ? ",\n" : "\n";
  }
  return text + "]\n}\n";
}

ordered_json feature(const char* type, ordered_json coordinates, ordered_json properties) {
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}};
}

}  // namespace

std::vector<Path> paths_of(const MapOutline& outline) {
  std::map<std::int32_t, std::vector<const NodeOutline*>> sessions;
  for (const NodeOutline& node : outline.nodes) {
    if (node.pose) sessions[node.map_id].push_back(&node);
  }
  std::vector<Path> paths;
  for (auto& [map_id, nodes] : sessions) {
    std::stable_sort(nodes.begin(), nodes.end(), [](const NodeOutline* a, const NodeOutline* b) {
      return a->stamp < b->stamp;
    });
    Path path{map_id, {}};
    const auto end_path = [&] {
      if (path.nodes.size() > 1) paths.push_back(path);
      path.nodes.clear();
    };
    for (const NodeOutline* node : nodes) {
      if (!path.nodes.empty() && jumps(*path.nodes.back(), *node)) end_path();
      path.nodes.push_back(node);
    }
    end_path();
  }
  return paths;
}

double yaw_rad(const Transform& transform) { return std::atan2(transform[4], transform[0]); }

std::string signatures_geojson(const MapOutline& outline) {
  std::vector<ordered_json> features;
  for (const NodeOutline& node : outline.nodes) {
    if (!node.pose) continue;
    const double yaw = yaw_rad(*node.pose);
    ordered_json properties = {{"id", node.id},
                               {"map_id", node.map_id},
                               {"weight", node.weight},
                               {"stamp", node.stamp},
                               {"label", node.label},
                               {"yaw", rounded(yaw, 1e4)},
                               {"yaw_deg", rounded(yaw * 180 / std::numbers::pi, 100)}};
    features.push_back(feature("Point", position(*node.pose), std::move(properties)));
  }
  return collection("signatures", features);
}

std::string trajectories_geojson(const std::vector<Path>& paths) {
  std::vector<ordered_json> features;
  for (const Path& path : paths) {
    ordered_json line = ordered_json::array();
    double length = 0;
    for (std::size_t i = 0; i < path.nodes.size(); ++i) {
      line.push_back(position(*path.nodes[i]->pose));
      if (i > 0) length += distance_m(*path.nodes[i - 1]->pose, *path.nodes[i]->pose);
    }
    ordered_json properties = {{"map_id", path.map_id},
                               {"signatures", path.nodes.size()},
                               {"length_m", rounded(length, 100)},
                               {"first_stamp", path.nodes.front()->stamp},
                               {"last_stamp", path.nodes.back()->stamp}};
    features.push_back(feature("LineString", std::move(line), std::move(properties)));
  }
  return collection("trajectories", features);
}

}  // namespace zonepack::packer
