// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/preload.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "runtime/odometry/det_math.hpp"
#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;
using testing_support::pose_at;
using testing_support::three_rooms;

constexpr std::int64_t kCycle_ns = 20'000'000;

// Three rooms whose loading takes 0.1 s; sigma 3 cm: at 1 m/s the horizon is 0.1 + 0.09 + 0.3 =
// 0.49 m.
class PreloadTest : public testing::Test {
 protected:
  const ZoneGraph graph = three_rooms();
  std::vector<float> load_s = std::vector<float>(3, 0.1f);
  Preload preload{graph, load_s};
  std::int64_t now_ns = 0;

  void at(PoseEstimate pose, ZoneId zone, double speed_m_s, double yaw_rate_rad_s = 0) {
    pose.t_ns = now_ns;
    pose.speed_m_s = speed_m_s;
    pose.yaw_rate_rad_s = yaw_rate_rad_s;
    now_ns += kCycle_ns;
    preload.update(pose, zone);
  }

  std::vector<ZoneId> approached() const {
    std::vector<ZoneId> zones;
    for (const Approach& approach : preload.approaches()) zones.push_back(approach.zone);
    return zones;
  }
};

using Zones = std::vector<ZoneId>;

TEST_F(PreloadTest, ApproachesTheZoneBehindADoorWithinTheHorizon) {
  at(pose_at(3.4, 2), 0, 1.0);  // 0.6 m
  EXPECT_EQ(approached(), Zones{});
  at(pose_at(3.55, 2), 0, 1.0);  // 0.45 m
  EXPECT_EQ(approached(), Zones{1});
  // Steps are 5 cm and more: the entry is known to within one.
  EXPECT_NEAR(preload.approaches()[0].entry_s, 0.45, 0.06);
}

TEST_F(PreloadTest, LooksFartherAheadForAZoneThatTakesLonger) {
  load_s.assign(3, 2.0f);
  Preload patient(graph, load_s);
  PoseEstimate pose = pose_at(1.8, 2);  // 2.2 m to the door; horizon 2 + 0.39 m
  pose.speed_m_s = 1;
  patient.update(pose, 0);
  ASSERT_EQ(patient.approaches().size(), 1u);
  EXPECT_EQ(patient.approaches()[0].zone, 1u);
}

TEST_F(PreloadTest, DoesNotApproachADoorThatIsMerelyPassed) {
  for (double y = 0.2; y < 3.8; y += 0.02) {
    at(pose_at(3.65, y, kPi / 2), 0, 1.0);  // 35 cm from the wall
    EXPECT_EQ(approached(), Zones{}) << y;
  }
}

TEST_F(PreloadTest, ApproachesTheDoorThatARobotMovesSidewaysTo) {
  // Facing north, 0.45 m from the door in the east; to the right is negative.
  PoseEstimate pose = pose_at(3.55, 2, kPi / 2);
  pose.sideways_m_s = 1;
  at(pose, 0, 0);
  EXPECT_EQ(approached(), Zones{});
  preload.restart();
  pose.sideways_m_s = -1;
  at(pose, 0, 0);
  EXPECT_EQ(approached(), Zones{1});
}

TEST_F(PreloadTest, DoesNotApproachAWall) {
  at(pose_at(3.8, 0.5), 0, 1.0);
  EXPECT_EQ(approached(), Zones{});
}

TEST_F(PreloadTest, FollowsTheArcOfATurnThroughADoor) {
  // Heading +y, turning right with radius 0.4 m: after 0.49 m, 70 degrees on, x is 0.26 m farther.
  at(pose_at(3.75, 1.7, kPi / 2), 0, 1.0, -2.5);
  EXPECT_EQ(approached(), Zones{1});
}

TEST_F(PreloadTest, DoesNotApproachADoorThatTheArcTurnsAwayFrom) {
  // Heading to the door 0.45 m away, turning left at 0.25 m: the path bends before it.
  at(pose_at(3.55, 1.6), 0, 1.0, 4.0);
  EXPECT_EQ(approached(), Zones{});
}

TEST_F(PreloadTest, LooksBackwardsWhenReversing) {
  at(pose_at(3.6, 2, kPi), 0, -1.0);  // facing away from the door
  EXPECT_EQ(approached(), Zones{1});
  Preload other(graph, load_s);
  PoseEstimate pose = pose_at(3.6, 2, 0);
  pose.speed_m_s = -1;
  other.update(pose, 0);
  EXPECT_TRUE(other.approaches().empty());
}

TEST_F(PreloadTest, ApproachesNothingNewWhileTurningInPlace) {
  for (int i = 0; i < 100; ++i) {
    at(pose_at(3.7, 2, wrap_angle(0.1 * i)), 0, 0.0, 5.0);
    EXPECT_EQ(approached(), Zones{});
  }
}

TEST_F(PreloadTest, KeepsAnApproachWhileStandingBeforeTheDoor) {
  at(pose_at(3.6, 2), 0, 1.0);
  for (int i = 0; i < 500; ++i) at(pose_at(3.65, 2), 0, 0.0);  // 10 s
  EXPECT_EQ(approached(), Zones{1});
}

TEST_F(PreloadTest, GivesUpAnApproachOnceThePathLeadsElsewhereForAWhile) {
  at(pose_at(3.6, 2), 0, 1.0);
  for (int i = 0; i < 10; ++i) at(pose_at(3.4, 2, kPi), 0, 1.0);  // 0.2 s
  EXPECT_EQ(approached(), Zones{1});
  for (int i = 0; i < 10; ++i) at(pose_at(3.2, 2, kPi), 0, 1.0);  // 0.4 s
  EXPECT_EQ(approached(), Zones{});
}

TEST_F(PreloadTest, KeepsBothZonesOfAPortalThatIsWithinThreeSigma) {
  at(pose_at(4.08, 2), 1, 1.0);  // just through the door, 8 cm < 9 cm
  EXPECT_EQ(approached(), Zones{0});
  EXPECT_FALSE(preload.approaches()[0].ahead);
}

TEST_F(PreloadTest, SeesTheZoneBehindTheNextWhenBothAreClose) {
  const GraphPortal portals[] = {{0, 1, {{4, 1}, {4, 3}}}, {1, 2, {{4.2, 1}, {4.2, 3}}}};
  const ZoneGraph thin({{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 4.2, 4)}, {"c", box(4.2, 0, 8, 4)}},
                       portals);
  Preload both(thin, load_s);
  PoseEstimate pose = pose_at(3.8, 2);
  pose.speed_m_s = 1;
  both.update(pose, 0);
  ASSERT_EQ(both.approaches().size(), 2u);
  EXPECT_EQ(both.approaches()[0].zone, 1u);
  EXPECT_EQ(both.approaches()[1].zone, 2u);
}

TEST_F(PreloadTest, SeesAPortalThatStandsBeforeTheBorderWhenThePoseIsBetween) {
  const GraphPortal portal{0, 1, {{3.95, 1.5}, {3.95, 2.5}}};
  const ZoneGraph graph_off({{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 8, 4)}}, {{portal}});
  Preload ahead(graph_off, load_s);
  PoseEstimate pose = pose_at(3.98, 2, 0, 0.005);
  pose.speed_m_s = 1;
  ahead.update(pose, 0);
  ASSERT_EQ(ahead.approaches().size(), 1u);
}

TEST_F(PreloadTest, KeepsTheSoonestWhenThereAreTooMany) {
  // Twelve doors within three sigma or ahead of a robot that does not know where it is.
  std::vector<GraphZone> zones{{"hall", box(0, 0, 13, 1)}};
  std::vector<GraphPortal> portals;
  for (int i = 0; i < 12; ++i) {
    zones.push_back({"r", box(i, 1, i + 1, 3)});
    portals.push_back({0, static_cast<ZoneId>(i + 1), {{i + 0.2, 1}, {i + 0.8, 1}}});
  }
  const ZoneGraph hall(std::move(zones), portals);
  const std::vector<float> loads(13, 0.1f);
  Preload many(hall, loads);
  many.update(pose_at(6, 0.5, 0, 5.0), 0);
  EXPECT_EQ(many.approaches().size(), Preload::kMaxApproaches);
}

TEST_F(PreloadTest, ForgetsEverythingOnARestart) {
  at(pose_at(3.6, 2), 0, 1.0);
  preload.restart();
  EXPECT_EQ(approached(), Zones{});
}

}  // namespace
}  // namespace zonepack
