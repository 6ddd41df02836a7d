// SPDX-License-Identifier: Apache-2.0
#include "packer/align/umeyama.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace zonepack::packer {
namespace {

const std::vector<Point3> kBent = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {1, 3, 0.5}};

// A quarter turn to the left about z, then 10, 20, 1: (x, y, z) goes to (10 - y, 20 + x, 1 + z).
std::vector<Point3> turned(double scale) {
  std::vector<Point3> out;
  for (const Point3& p : kBent) {
    out.push_back({10 - scale * p[1], 20 + scale * p[0], 1 + scale * p[2]});
  }
  return out;
}

TEST(Umeyama, FindsATurnAndAShift) {
  const PointFit found = fit_points(kBent, turned(1), FitModel::kRigid);
  EXPECT_NEAR(found.rms_m, 0, 1e-12);
  EXPECT_NEAR(found.scale_found, 1, 1e-12);
  const Point3 p = found.T_to_from(Point3{2, 5, 7});  // 10 - 5, 20 + 2, 1 + 7
  EXPECT_NEAR(p[0], 5, 1e-12);
  EXPECT_NEAR(p[1], 22, 1e-12);
  EXPECT_NEAR(p[2], 8, 1e-12);
}

TEST(Umeyama, FindsAScaleAndSaysItWhereItMayNotUseIt) {
  const PointFit scaled = fit_points(kBent, turned(2.5), FitModel::kSimilarity);
  EXPECT_NEAR(scaled.T_to_from.scale, 2.5, 1e-12);
  EXPECT_NEAR(scaled.largest_m, 0, 1e-11);
  const PointFit rigid = fit_points(kBent, turned(2.5), FitModel::kRigid);
  EXPECT_EQ(rigid.T_to_from.scale, 1);
  EXPECT_NEAR(rigid.scale_found, 2.5, 1e-12);
  EXPECT_GT(rigid.rms_m, 1);
}

// The centroid takes a quarter of the one error of 0.4 m. Its size alone: the turn hardly changes.
TEST(Umeyama, ShowsTheResidualOfAWrongPair) {
  std::vector<Point3> to = turned(1);
  to[3][2] += 0.4;
  const PointFit found = fit_points(kBent, to, FitModel::kRigid);
  ASSERT_EQ(found.residuals_m.size(), 4u);
  EXPECT_GT(found.largest_m, 0.05);
  EXPECT_LT(found.largest_m, 0.4);
  EXPECT_LT(found.rms_m, found.largest_m);
}

TEST(Umeyama, NeverMirrors) {
  std::vector<Point3> mirrored = kBent;
  for (Point3& p : mirrored) p[0] = -p[0];
  const auto& R = fit_points(kBent, mirrored, FitModel::kRigid).T_to_from.rotation;
  const double determinant = R[0] * (R[4] * R[8] - R[5] * R[7]) -
                             R[1] * (R[3] * R[8] - R[5] * R[6]) +
                             R[2] * (R[3] * R[7] - R[4] * R[6]);
  EXPECT_NEAR(determinant, 1, 1e-12);
}

// The base looks along +x; after the quarter turn it looks along +y.
TEST(Umeyama, TurnsPosesAndDoesNotScaleTheirRotation) {
  const PointFit found = fit_points(kBent, turned(2), FitModel::kSimilarity);
  const Transform T = found.T_to_from(Transform{1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0});
  EXPECT_NEAR(T[0], 0, 1e-6);
  EXPECT_NEAR(T[4], 1, 1e-6);
  EXPECT_NEAR(T[3], 10, 1e-5);
  EXPECT_NEAR(T[7], 26, 1e-5);
}

TEST(Umeyama, RefusesWhatDeterminesNothing) {
  const std::vector<Point3> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  EXPECT_THROW(fit_points(line, turned(1), FitModel::kRigid), std::runtime_error);
  EXPECT_THROW(fit_points(kBent, line, FitModel::kRigid), std::runtime_error);
  const std::vector<Point3> two(kBent.begin(), kBent.begin() + 2);
  EXPECT_THROW(fit_points(two, two, FitModel::kRigid), std::runtime_error);
  std::vector<Point3> bad = kBent;
  bad[1][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fit_points(kBent, bad, FitModel::kRigid), std::runtime_error);
}

}  // namespace
}  // namespace zonepack::packer
