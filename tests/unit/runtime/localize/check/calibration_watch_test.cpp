// SPDX-License-Identifier: Apache-2.0
// A camera that drives over a floor of made-up points, with a calibration that is off.
#include "runtime/localize/check/calibration_watch.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "runtime/localize/solve/refine.hpp"
#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Fixes of `real`, found with `calibration`: pixels are half a pixel off at random.
CalibrationWatch watch_of(const CameraModel& real, const CameraModel& calibration, int fixes) {
  CalibrationWatch watch;
  std::mt19937 random(7);
  const auto noise = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (int i = 0; i < fixes; ++i) {
    const Eigen::Isometry3d T_map_base = lift({0.3 * i, 1, 0.1 * i}, 0.4);
    std::vector<Sighting> sightings = made_sightings(real, T_map_base, 60);
    for (Sighting& one : sightings) one.px += Eigen::Vector2d(noise(), noise());
    PlanePrior plane;
    plane.floor_z_m = 0.4;
    const Refined refined = refine(sightings, calibration, T_map_base, plane);
    EXPECT_TRUE(refined.valid);
    QueryResult fix;
    fix.accepted = true;
    fix.T_map_base = refined.T_map_base;
    fix.floor_z_m = 0.4;
    fix.inliers = fix.distinct = 60;
    for (const Sighting& one : sightings) {
      DrawnMatch match;
      match.x_px = static_cast<float>(one.px.x());
      match.y_px = static_cast<float>(one.px.y());
      match.p_map = one.p_map.cast<float>();
      match.inlier = true;
      fix.drawn.push_back(match);
    }
    watch.add(calibration, fix);
  }
  return watch;
}

CalibrationReport report_with(const CameraTraits& off, int fixes = 60) {
  const CameraModel real = made_camera();
  return watch_of(real, corrected(real, off), fixes).report();
}

TEST(CalibrationWatch, FindsNothingWrongWithACalibrationThatIsRight) {
  const CalibrationReport report = report_with({});
  EXPECT_TRUE(report.enough);
  EXPECT_EQ(report.fixes, 60u);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_LT(std::abs(report.each[0].value), 0.002);
}

// Each trait alone, by as much as it is off and the other way round: what is to be put right. Some
// of it hides, as points far off count for less.
TEST(CalibrationWatch, FindsWhatIsWrong) {
  struct Case {
    CameraTrait trait;
    double off;
  };
  for (const Case& c :
       {Case{CameraTrait::kFocal, 0.01}, Case{CameraTrait::kFocal, -0.01},
        Case{CameraTrait::kHeight, 0.02}, Case{CameraTrait::kHeight, -0.02},
        Case{CameraTrait::kPitch, 0.5 * kDegree}, Case{CameraTrait::kRoll, -0.5 * kDegree}}) {
    CameraTraits off{};
    off[static_cast<std::size_t>(c.trait)] = c.off;
    const CalibrationReport report = report_with(off);
    ASSERT_EQ(report.findings.size(), 1u) << to_string(c.trait);
    EXPECT_EQ(report.findings[0].trait, c.trait);
    EXPECT_NEAR(report.findings[0].value / -c.off, 1, 0.25) << to_string(c.trait);
    EXPECT_LT(report.findings[0].sigma, std::abs(c.off) / 5);
  }
}

TEST(CalibrationWatch, FindsTwoThingsTogether) {
  const CalibrationReport report = report_with({0.015, 0, 0, 0.7 * kDegree});
  ASSERT_EQ(report.findings.size(), 2u);
  for (const CalibrationFinding& finding : report.findings) {
    EXPECT_TRUE(finding.trait == CameraTrait::kFocal || finding.trait == CameraTrait::kRoll);
    EXPECT_LT(finding.value, 0);
  }
}

// 10 groups of 4.
TEST(CalibrationWatch, SaysNothingAfterAFewFixes) {
  EXPECT_FALSE(report_with({0.02, 0, 0, 0}, 36).enough);
  EXPECT_TRUE(report_with({0.02, 0, 0, 0}, 36).findings.empty());
  EXPECT_TRUE(report_with({0.02, 0, 0, 0}, 37).enough);
}

// More than 32 groups of 4: groups are joined, and the sum is the same.
TEST(CalibrationWatch, KeepsItsStateSmallOnALongDrive) {
  const CalibrationReport report = report_with({0.01, 0, 0, 0}, 300);
  EXPECT_EQ(report.fixes, 300u);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_NEAR(report.findings[0].value, -0.01, 0.0025);
}

TEST(CalibrationWatch, TakesNothingFromAQueryThatWasNotAccepted) {
  CalibrationWatch watch;
  watch.add(made_camera(), QueryResult{});
  EXPECT_EQ(watch.fixes(), 0u);
}

// Half a degree of pitch turns the view down: its z axis, which looked level, points below.
TEST(CorrectedCamera, LooksLowerWithPitchAndSitsHigherWithHeight) {
  const CameraModel camera = corrected(made_camera(), {0.1, 0.05, 0.5 * kDegree, 0});
  EXPECT_NEAR(camera.fx, 423.5, 1e-9);
  EXPECT_NEAR(camera.T_base_camera.translation().z(), 0.55, 1e-12);
  EXPECT_NEAR(camera.T_base_camera.linear().col(2).z(), -std::sin(0.5 * kDegree), 1e-12);
}

}  // namespace
}  // namespace zonepack::localize
