// SPDX-License-Identifier: Apache-2.0
// Tracker and preload along a recorded loop through the sample building, forwards, backwards,
// mirrored, at several speeds and with noise: every zone is approached in time, and none that is
// not entered.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "runtime/odometry/det_math.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/tracker.hpp"
#include "tests/support/building.hpp"

namespace zonepack {
namespace {

using testing_support::Building;
using testing_support::TrueSample;

struct Variation {
  bool reversed = false;
  bool mirrored = false;
  double pace = 1;
  double noise_m = 0.04;
  std::uint32_t seed = 1;
};

struct MissionEnd {
  int entries = 0;
  int late = 0;        // entered before it was wanted for as long as loading takes
  int needless = 0;    // wanted, never entered
  double wrong_s = 0;  // truth more than 0.3 m inside another zone than the tracker's
};

constexpr double kCycle_s = 0.02;
constexpr float kLoad_s = 0.06f;

void mirror(Point2& point) { point.x_m = -point.x_m; }

Building mirrored(Building building) {
  for (GraphZone& zone : building.zones) {
    for (Point2& point : zone.polygon.outer) mirror(point);
  }
  for (GraphPortal& portal : building.portals) {
    mirror(portal.segment.p);
    mirror(portal.segment.q);
  }
  return building;
}

std::vector<TrueSample> varied(std::vector<TrueSample> path, const Variation& variation) {
  const double start_s = path.front().t_s, end_s = path.back().t_s;
  for (TrueSample& sample : path) {
    if (variation.reversed) {
      sample.t_s = end_s - (sample.t_s - start_s);
      sample.pose.yaw_rad = wrap_angle(sample.pose.yaw_rad + kPi);
      sample.yaw_rate_rad_s = -sample.yaw_rate_rad_s;
    }
    if (variation.mirrored) {
      sample.pose.x_m = -sample.pose.x_m;
      sample.pose.yaw_rad = wrap_angle(kPi - sample.pose.yaw_rad);
      sample.yaw_rate_rad_s = -sample.yaw_rate_rad_s;
    }
    sample.t_s = (sample.t_s - start_s) / variation.pace;
    sample.speed_m_s *= variation.pace;
    sample.yaw_rate_rad_s *= variation.pace;
  }
  if (variation.reversed) std::reverse(path.begin(), path.end());
  return path;
}

MissionEnd drive(const Variation& variation) {
  const std::string data = ZONEPACK_TEST_DATA;
  Building building = testing_support::read_building(data + "/zones.geojson");
  if (variation.mirrored) building = mirrored(std::move(building));
  const ZoneGraph graph(building.zones, building.portals);
  const auto path = varied(
      testing_support::read_true_path(data + "/scenario1_loop/base_groundtruth.txt"), variation);
  const std::vector<float> load_s(graph.zone_count(), kLoad_s);
  ZoneTracker tracker(graph);
  Preload preload(graph, load_s);
  std::mt19937 random(variation.seed);
  std::normal_distribution<double> normal;

  MissionEnd outcome;
  double error_x = 0, error_y = 0;
  ZoneId true_zone = kNoZone;
  std::map<ZoneId, double> wanted_since;
  std::map<ZoneId, bool> entered;
  std::size_t k = 0;
  for (double t = 0; t < path.back().t_s; t += kCycle_s) {
    while (k + 2 < path.size() && path[k + 1].t_s <= t) ++k;
    const TrueSample &a = path[k], &b = path[k + 1];
    const double part = (t - a.t_s) / (b.t_s - a.t_s);
    const Point2 truth{a.pose.x_m + part * (b.pose.x_m - a.pose.x_m),
                       a.pose.y_m + part * (b.pose.y_m - a.pose.y_m)};
    // Errors of a filter corrected once a second: they wander within noise_m.
    const double step = std::sqrt(2 * kCycle_s) * variation.noise_m;
    error_x += step * normal(random) - kCycle_s * error_x;
    error_y += step * normal(random) - kCycle_s * error_y;
    PoseEstimate pose;
    pose.t_ns = static_cast<std::int64_t>(t * 1e9);
    pose.T_map_base = {
        truth.x_m + error_x, truth.y_m + error_y,
        wrap_angle(a.pose.yaw_rad + part * wrap_angle(b.pose.yaw_rad - a.pose.yaw_rad) +
                   0.01 * normal(random))};
    pose.covariance.xx = pose.covariance.yy = variation.noise_m * variation.noise_m;
    pose.covariance.yaw_yaw = 1e-4;
    pose.speed_m_s = a.speed_m_s + 0.03 * normal(random);
    pose.yaw_rate_rad_s = a.yaw_rate_rad_s + 0.08 * normal(random);
    pose.valid = pose.trusted = true;
    tracker.update(pose);
    preload.update(pose, tracker.pose_zone());

    std::map<ZoneId, double> wanted{{tracker.zone(), t}, {tracker.pose_zone(), t}};
    for (const Approach& approach : preload.approaches()) wanted[approach.zone] = t;
    for (const auto& [zone, since] : wanted) wanted_since.emplace(zone, since);
    const ZoneId zone = graph.zone_at(truth);
    if (zone != tracker.zone() && graph.depth_m(zone, truth) > 0.3) outcome.wrong_s += kCycle_s;
    entered[zone] = true;
    if (zone != true_zone && true_zone != kNoZone) {
      ++outcome.entries;
      const auto since = wanted_since.find(zone);
      outcome.late += since == wanted_since.end() || t - since->second < double{kLoad_s};
    }
    true_zone = zone;
    for (auto it = wanted_since.begin(); it != wanted_since.end();) {
      if (wanted.count(it->first) > 0) {
        ++it;
        continue;
      }
      outcome.needless += !entered[it->first];
      entered[it->first] = false;
      it = wanted_since.erase(it);
    }
  }
  return outcome;
}

TEST(Mission, PreloadsEveryZoneOfTheLoopInTimeAndNoOther) {
  for (const bool reversed : {false, true}) {
    for (const bool mirror_image : {false, true}) {
      for (const double pace : {0.5, 1.0, 1.5}) {
        for (const double noise_m : {0.01, 0.04, 0.08}) {
          SCOPED_TRACE(testing::Message() << "reversed " << reversed << " mirrored " << mirror_image
                                          << " pace " << pace << " noise " << noise_m);
          const MissionEnd outcome = drive({reversed, mirror_image, pace, noise_m, 5});
          EXPECT_EQ(outcome.entries, 5);  // L1 H1 C2 H2 C3 L1
          EXPECT_EQ(outcome.late, 0);
          EXPECT_EQ(outcome.needless, 0);
          EXPECT_LE(outcome.wrong_s, 0.2);  // 0.2 % of 110 s
        }
      }
    }
  }
}

}  // namespace
}  // namespace zonepack
