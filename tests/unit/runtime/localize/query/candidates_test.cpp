// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/candidates.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/solve/sighting.hpp"
#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

// A signature at the pose that saw `points` points 3 m ahead of its base.
MapFeatures signature(SignatureId id, const Pose2& pose, std::size_t points, double floor_z_m = 0) {
  MapFeatures out;
  out.id = id;
  out.T_map_base = lift(pose, floor_z_m);
  out.T_base_camera = made_camera().T_base_camera;
  out.points.assign(points, {320, 240, 3, 0, 0.5F});
  return out;
}

Candidates choose(const std::vector<MapFeatures>& map, const Pose2& at, std::size_t most = 12) {
  std::vector<const MapFeatures*> all;
  for (const MapFeatures& one : map) all.push_back(&one);
  return choose_candidates(all, made_camera(), {at, {}}, most);
}

TEST(Candidates, AreThoseWithMostPointsInViewFirst) {
  // Every fifth point is counted: 10 of 50, 20 of 100.
  const std::vector<MapFeatures> map{signature(1, {0, 0, 0}, 50), signature(2, {0.5, 0, 0}, 100)};
  const Candidates found = choose(map, {0, 0, 0});
  ASSERT_EQ(found.best.size(), 2u);
  EXPECT_EQ(found.best[0].map->id, 2u);
  EXPECT_EQ(found.best[0].in_view, 20u);
  EXPECT_EQ(found.best[1].in_view, 10u);
  EXPECT_EQ(choose(map, {0, 0, 0}, 1).best.size(), 1u);
  EXPECT_EQ(choose(map, {0, 0, 0}, 1).reach.size(), 2u);
}

TEST(Candidates, LookAboutTheSameWay) {
  const double degree = std::numbers::pi / 180;
  // The point is 3 m ahead of each: from 60 degrees to the side the camera still sees it only if it
  // lies before the camera, so the signature stands such that its point is at (3, 0).
  const auto looks = [&](double turn) {
    return signature(1, {3 - 3 * std::cos(turn), -3 * std::sin(turn), turn}, 50);
  };
  EXPECT_EQ(choose({looks(60 * degree)}, {0, 0, 0}).reach.size(), 1u);
  EXPECT_EQ(choose({looks(80 * degree)}, {0, 0, 0}).reach.size(), 0u);  // over 70
  const Candidates away = choose({looks(80 * degree)}, {0, 0, 0});
  EXPECT_EQ(away.near, 1u);
  ASSERT_NE(away.nearest, nullptr);
  EXPECT_NEAR(away.nearest_turn_rad, 80 * degree, 1e-6);
}

TEST(Candidates, SeeThePointsFromAboutTheSameDistance) {
  // The signature's camera is 2.8 m from its points, which lie at x = 3. From x = 2.3 the camera at
  // 2.5 is 0.5 m away, 0.18 times as far: under 0.4. From x = 1 it is 1.8 m away, 0.64 times.
  const std::vector<MapFeatures> map{signature(1, {0, 0, 0}, 50)};
  EXPECT_EQ(choose(map, {1, 0, 0}).reach.size(), 1u);
  EXPECT_EQ(choose(map, {2.3, 0, 0}).reach.size(), 0u);
}

TEST(Candidates, AreWithinTwelveMetres) {
  EXPECT_TRUE(in_reach(lift({11.9, 0, 0}, 0), {{0, 0, 0}, {}}));
  EXPECT_FALSE(in_reach(lift({12.1, 0, 0}, 0), {{0, 0, 0}, {}}));
  EXPECT_EQ(choose({signature(1, {13, 0, 0}, 50)}, {0, 0, 0}).near, 0u);
}

TEST(Candidates, SayHowHighTheFloorIs) {
  // 10 points counted at 3 cm and 20 at 9 cm: (10 * 3 + 20 * 9) / 30 = 7 cm.
  const std::vector<MapFeatures> map{signature(1, {0, 0, 0}, 50, 0.03),
                                     signature(2, {0.1, 0, 0}, 100, 0.09)};
  EXPECT_NEAR(choose(map, {0, 0, 0}).floor_z_m, 0.07, 1e-9);
}

TEST(Candidates, SpanThePriorByOneStandardDeviationEachWay) {
  const auto poses = spanning_poses({{1, 2, 0.5}, {0.09, 0, 0, 0.04, 0, 0.01}});
  EXPECT_EQ(poses[0], (Pose2{1, 2, 0.5}));
  EXPECT_NEAR(poses[1].x_m, 1.3, 1e-6);  // sqrt 0.09
  EXPECT_NEAR(poses[2].x_m, 0.7, 1e-6);
  EXPECT_NEAR(poses[3].y_m, 2.2, 1e-6);
  EXPECT_NEAR(poses[5].yaw_rad, 0.6, 1e-6);
}

}  // namespace
}  // namespace zonepack::localize
