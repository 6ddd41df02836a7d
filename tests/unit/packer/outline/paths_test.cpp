// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/paths.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace zonepack::packer {
namespace {

using ::testing::ElementsAre;

Transform at(float x, float y) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0}; }

NodeOutline node(std::int32_t id, std::int32_t map_id, double stamp, float x, float odometry_x) {
  NodeOutline result;
  result.id = id;
  result.map_id = map_id;
  result.stamp = stamp;
  result.pose = at(x, 0);
  result.odometry_pose = at(odometry_x, 0);
  return result;
}

std::vector<std::vector<std::int32_t>> ids(const std::vector<Path>& paths) {
  std::vector<std::vector<std::int32_t>> result;
  for (const Path& path : paths) {
    result.emplace_back();
    for (const NodeOutline* n : path.nodes) result.back().push_back(n->id);
  }
  return result;
}

TEST(Paths, FollowEachSessionInOrderOfStamp) {
  MapOutline outline;
  outline.nodes = {node(1, 0, 30, 2, 2), node(2, 0, 10, 0, 0), node(3, 1, 5, 9, 0),
                   node(4, 0, 20, 1, 1), node(5, 1, 6, 10, 1)};
  EXPECT_THAT(ids(paths_of(outline)), ElementsAre(ElementsAre(2, 4, 1), ElementsAre(3, 5)));
}

TEST(Paths, EndWherePosesJump) {
  MapOutline outline;
  // From 2 to 3 odometry says 1 m, the map 3 m: more than 1 m + 10 %.
  outline.nodes = {node(1, 0, 1, 0, 0), node(2, 0, 2, 1, 1), node(3, 0, 3, 4, 2),
                   node(4, 0, 4, 5, 3), node(5, 0, 5, 25, 22.5f)};
  // From 4 to 5: 20 m against 19.5 m is no jump.
  EXPECT_THAT(ids(paths_of(outline)), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4, 5)));
}

TEST(Paths, EndAfterTenMetresWithoutOdometry) {
  MapOutline outline;
  outline.nodes = {node(1, 0, 1, 0, 0), node(2, 0, 2, 9, 0), node(3, 0, 3, 20, 0),
                   node(4, 0, 4, 21, 0)};
  for (NodeOutline& n : outline.nodes) n.odometry_pose.reset();
  EXPECT_THAT(ids(paths_of(outline)), ElementsAre(ElementsAre(1, 2), ElementsAre(3, 4)));
}

TEST(Paths, LeaveOutNodesWithoutAPoseAndLoneNodes) {
  MapOutline outline;
  outline.nodes = {node(1, 0, 1, 0, 0), node(2, 0, 2, 1, 1), node(3, 0, 3, 2, 2),
                   node(4, 7, 4, 0, 0)};
  outline.nodes[1].pose.reset();
  EXPECT_THAT(ids(paths_of(outline)), ElementsAre(ElementsAre(1, 3)));
}

TEST(Paths, BecomeLineStringsInMetres) {
  MapOutline outline;
  outline.nodes = {node(1, 3, 1.5, 0.12345678f, 0), node(2, 3, 2.5, 1, 1)};
  const auto json = nlohmann::json::parse(trajectories_geojson(paths_of(outline)));
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::3857");
  ASSERT_EQ(json["features"].size(), 1u);
  const auto& line = json["features"][0];
  EXPECT_EQ(line["geometry"]["type"], "LineString");
  EXPECT_EQ(line["geometry"]["coordinates"].dump(), "[[0.1235,0.0],[1.0,0.0]]");
  EXPECT_EQ(line["properties"]["map_id"], 3);
  EXPECT_EQ(line["properties"]["signatures"], 2);
  EXPECT_EQ(line["properties"]["length_m"], 0.88);
  EXPECT_EQ(line["properties"]["first_stamp"], 1.5);
}

TEST(SignaturesGeojson, BecomePointsWithTheirHeading) {
  MapOutline outline;
  outline.nodes = {node(1, 0, 1.25, 2, 0), node(2, 0, 2, 1, 1)};
  outline.nodes[0].pose = Transform{0, -1, 0, 2, 1, 0, 0, -3, 0, 0, 1, 0};  // looks north
  outline.nodes[0].weight = -1;
  outline.nodes[0].label = "door \"\xff\"";
  outline.nodes[1].pose.reset();
  const auto json = nlohmann::json::parse(signatures_geojson(outline));
  ASSERT_EQ(json["features"].size(), 1u);
  const auto& point = json["features"][0];
  EXPECT_EQ(point["geometry"].dump(), R"({"coordinates":[2.0,-3.0],"type":"Point"})");
  EXPECT_EQ(point["properties"]["id"], 1);
  EXPECT_EQ(point["properties"]["weight"], -1);
  EXPECT_EQ(point["properties"]["stamp"], 1.25);
  EXPECT_EQ(point["properties"]["yaw"], 1.5708);
  EXPECT_EQ(point["properties"]["yaw_deg"], 90);
}

}  // namespace
}  // namespace zonepack::packer
