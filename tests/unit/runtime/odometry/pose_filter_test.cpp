// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/pose_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/runtime/odometry/simulated_drive.hpp"

namespace zonepack {
namespace {

using Verdict = CorrectionVerdict;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(PoseFilter, KnowsNothingBeforeTheFirstFix) {
  SimulatedDrive drive;
  drive.steps(10);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).valid);
  EXPECT_TRUE(drive.filter.hypotheses().empty());
}

TEST(PoseFilter, IsTrustedAfterTwoFixesAgreeThroughOdometry) {
  SimulatedDrive drive;
  drive.steps(5);
  EXPECT_EQ(drive.correct_now(), Verdict::kHypothesis);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).valid);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  drive.steps(100);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_EQ(drive.filter.hypotheses().size(), 1u);
  EXPECT_LT(drive.error_m(), 1e-9);
  EXPECT_EQ(drive.filter.counters().used, 2u);
}

TEST(PoseFilter, TheSamePlaceFixedTwiceIsNoAgreementWhenTheRobotMoved) {
  SimulatedDrive drive;
  drive.steps(5);
  const PoseCorrection first = drive.fix(drive.now());
  drive.filter.correct(first, drive.now());
  drive.steps(100);  // 2 m on
  PoseCorrection again = first;
  again.stamp_ns = drive.now();
  EXPECT_EQ(drive.filter.correct(again, drive.now()), Verdict::kHypothesis);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_EQ(drive.filter.hypotheses().size(), 2u);
}

TEST(PoseFilter, ListsUpToFourHypothesesAndTrustsTheOneThatIsConfirmed) {
  SimulatedDrive drive;
  drive.steps(5);
  for (int i = 1; i <= 6; ++i) {
    EXPECT_EQ(drive.correct_now(i * 5.0, 0, 0), Verdict::kHypothesis);
    drive.steps(50);
  }
  EXPECT_EQ(drive.filter.hypotheses().size(), kMaxHypotheses);
  EXPECT_EQ(drive.correct_now(), Verdict::kHypothesis);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
  EXPECT_LT(drive.error_m(), 1e-9);
}

// A wrong second fix would move the robot's zone, and the next one move it again.
TEST(PoseFilter, WithoutTrustTheOlderHypothesisStaysCurrentUntilAnotherHasMoreSupport) {
  SimulatedDrive drive;
  drive.steps(5);
  EXPECT_EQ(drive.correct_now(), Verdict::kHypothesis);
  for (int i = 1; i <= 6; ++i) {  // more than there is room for
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(i * 5.0, 0, 0), Verdict::kHypothesis);
    EXPECT_LT(drive.error_m(), 1e-9) << i;
  }
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(30, 0, 0), Verdict::kTrusted);
  EXPECT_NEAR(drive.error_m(), 30, 1e-6);
}

TEST(PoseFilter, RefusesWhatNoPoseCanBe) {
  SimulatedDrive drive;
  drive.steps(5);
  const auto refused = [&](auto change) {
    PoseCorrection fix = drive.fix(drive.now());
    change(fix);
    return drive.filter.correct(fix, drive.now()) == Verdict::kInvalid;
  };
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.T_map_base.yaw_rad = 90; }));  // degrees
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.T_map_base.yaw_rad = -270; }));
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.T_map_base.x_m = 3e38; }));
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.T_map_base.y_m = -1e6; }));
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.sigma_x_m = 0; }));
  EXPECT_TRUE(refused([](PoseCorrection& fix) { fix.sigma_yaw_rad = kInfinite; }));
  EXPECT_FALSE(refused([](PoseCorrection& fix) { fix.T_map_base.yaw_rad = 6.25; }));
  EXPECT_EQ(drive.filter.counters().invalid, 6u);
}

TEST(PoseFilter, AGivenStartIsAGuessThatHoldsUntilFixesAgree) {
  SimulatedDrive drive;
  drive.filter.start_at(0, {}, 0.1, 0.05);
  drive.steps(50);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).valid);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_LT(drive.error_m(), 1e-9);
  // One fix that contradicts does not move the pose, but its place is listed.
  EXPECT_EQ(drive.correct_now(4, 0, 0), Verdict::kHypothesis);
  EXPECT_LT(drive.error_m(), 1e-9);
  EXPECT_EQ(drive.filter.hypotheses().size(), 2u);
  // One that agrees is better than the guess, but not yet trusted.
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(0.05, 0, 0), Verdict::kHypothesis);
  EXPECT_NEAR(drive.error_m(), 0.05, 1e-9);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
}

TEST(PoseFilter, AWrongStartIsOverruledByTwoFixes) {
  SimulatedDrive drive;
  drive.filter.start_at(0, {10, 10, 2}, 0.1, 0.05);
  drive.steps(50);
  drive.correct_now();
  EXPECT_GT(drive.error_m(), 5);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
  EXPECT_LT(drive.error_m(), 1e-9);
}

TEST(PoseFilter, RefusesFixesOutsideTheGate) {
  SimulatedDrive drive;
  drive.trust();
  EXPECT_EQ(drive.correct_now(2, 0, 0), Verdict::kOutlier);
  EXPECT_EQ(drive.correct_now(0, 0, 0.5), Verdict::kOutlier);
  EXPECT_EQ(drive.correct_now(0.02, 0.02, 0.005), Verdict::kUsed);
  EXPECT_LT(drive.error_m(), 0.03);
  EXPECT_EQ(drive.filter.counters().outliers, 2u);
}

TEST(PoseFilter, NoFixIsBelievedToBePerfect) {
  SimulatedDrive drive;
  drive.trust();
  PoseCorrection fix = drive.fix(drive.now());
  fix.sigma_x_m = fix.sigma_y_m = fix.sigma_yaw_rad = 1e-12;
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kUsed);
  const Covariance2 covariance = drive.filter.estimate(drive.now()).covariance;
  EXPECT_GT(std::sqrt(covariance.xx), 0.004);  // 5 mm, and what was known before
  EXPECT_GT(std::sqrt(covariance.yaw_yaw), 0.0009);
}

TEST(PoseFilter, RefusesWhatIsTooOldFromTheFutureOrNotANumber) {
  SimulatedDrive drive;
  drive.trust();
  drive.steps(300);  // 6 s; the history has 5
  EXPECT_EQ(drive.correct(drive.now() - 5500 * kMs), Verdict::kTooOld);
  PoseCorrection fix = drive.fix(drive.now());
  fix.stamp_ns += 60 * kMs;
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kFromFuture);
  for (const double bad : {kNotANumber, kInfinite, -kInfinite}) {
    for (int field = 0; field < 6; ++field) {
      fix = drive.fix(drive.now());
      double* const places[] = {&fix.T_map_base.x_m, &fix.T_map_base.y_m, &fix.T_map_base.yaw_rad,
                                &fix.sigma_x_m,      &fix.sigma_y_m,      &fix.sigma_yaw_rad};
      *places[field] = bad;
      EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kInvalid);
    }
  }
  for (const double bad : {0.0, -0.03}) {
    fix = drive.fix(drive.now());
    fix.sigma_yaw_rad = bad;
    EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kInvalid);
  }
  EXPECT_EQ(drive.filter.counters().invalid, 20u);
  EXPECT_EQ(drive.filter.counters().too_old, 1u);
  EXPECT_EQ(drive.filter.counters().from_future, 1u);
  EXPECT_EQ(drive.filter.counters().rejected, 22u);
  EXPECT_LT(drive.error_m(), 1e-9);
}

TEST(PoseFilter, ARunOfRefusedFixesThatAgreeMovesThePose) {
  SimulatedDrive drive;
  drive.trust();
  // The robot was carried: all fixes are 3 m off, consistently.
  EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kOutlier);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kOutlier);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kReinitialised);
  EXPECT_NEAR(drive.error_m(), 3, 1e-9);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_EQ(drive.filter.counters().reinitialised, 1u);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kUsed);
}

TEST(PoseFilter, AfterAMoveFixesOfTheOldPlaceCountNoMore) {
  SimulatedDrive drive;
  drive.trust();
  drive.steps(100);
  EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
  // Three fixes from before that one come late, and agree on another place.
  for (const int ago_ms : {600, 400, 200}) drive.correct(drive.now() - ago_ms * kMs, 3, 0, 0);
  EXPECT_EQ(drive.filter.counters().reinitialised, 1u);
  EXPECT_NEAR(drive.error_m(), 3, 1e-9);
}

TEST(PoseFilter, RefusedFixesThatDisagreeOrAreInterruptedDoNotMoveThePose) {
  SimulatedDrive drive;
  drive.trust();
  for (int i = 0; i < 20; ++i) {
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(2 + i, -i, 0), Verdict::kOutlier);
  }
  for (int i = 0; i < 20; ++i) {
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kOutlier);
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
  }
  EXPECT_LT(drive.error_m(), 1e-9);
}

// Two localizers that contradict each other, each consistent in itself: which is right is unknown.
TEST(PoseFilter, IsNotTrustedWhileRefusedFixesKeepAgreeingWithEachOther) {
  SimulatedDrive drive;
  drive.trust();
  for (int i = 1; i <= 3; ++i) {
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(3, 0, 0), Verdict::kOutlier);
    EXPECT_EQ(drive.filter.estimate(drive.now()).trusted, i < 3);
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
  }
  ASSERT_EQ(drive.filter.hypotheses().size(), 2u);
  const Pose2 other = drive.filter.hypotheses()[1].T_map_base;
  EXPECT_NEAR(other.x_m, drive.truth.back().x_m + 3, 1e-9);
  EXPECT_LT(drive.error_m(), 1e-9);
  for (int i = 0; i < 7; ++i) {
    drive.steps(50);
    EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
  }
  EXPECT_TRUE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_EQ(drive.filter.hypotheses().size(), 1u);
}

// Trusted in the wrong place, every second fix wrong in its own way: good ones still win.
TEST(PoseFilter, IsNotLockedOutWhileEverySecondFixIsWrong) {
  SimulatedDrive drive;
  drive.steps(5);
  drive.correct_now(8, 8, 0);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(8, 8, 0), Verdict::kTrusted);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(1, 9);
  int fixes = 0;
  while (drive.error_m() > 0.1 && fixes < 20) {
    drive.steps(50);
    ++fixes % 2 == 0 ? drive.correct_now(off(random), off(random), off(random) / 5)
                     : drive.correct_now();
  }
  EXPECT_EQ(fixes, 5);  // the third good one
}

TEST(PoseFilter, WithoutFixesTheUncertaintyGrowsAndAFixIsTakenBack) {
  SimulatedDrive drive;
  drive.trust();
  const double before = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  drive.steps(3000);
  const double after = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  EXPECT_GT(after, before * 3);
  EXPECT_EQ(drive.correct_now(2 * after, 0, 0), Verdict::kUsed);
}

TEST(PoseFilter, CarriesSidewaysMotionOnToNow) {
  PoseFilter filter{PoseFilterSettings{}};
  filter.start_at(0, {});
  for (int i = 1; i <= 100; ++i) {
    OdometryIncrement increment;
    increment.from_ns = (i - 1) * 20 * kMs;
    increment.to_ns = i * 20 * kMs;
    increment.motion.pose = {0, 0.01, 0};  // 0.5 m/s to the left
    increment.sideways_m_s = 0.5;
    filter.predict(increment);
  }
  // 1 m by the last increment, 2.5 cm in the 50 ms since.
  const PoseEstimate estimate = filter.estimate(2050 * kMs);
  EXPECT_NEAR(estimate.T_map_base.y_m, 1.025, 1e-6);
  EXPECT_NEAR(estimate.sideways_m_s, 0.5, 1e-6);
  filter.drift_until(3000 * kMs);
  EXPECT_EQ(filter.estimate(3000 * kMs).sideways_m_s, 0);
}

TEST(PoseFilter, AResetIsBelievedAtOnceWhereverItLeads) {
  SimulatedDrive drive;
  drive.steps(5);
  EXPECT_EQ(drive.filter.reset(drive.fix(drive.now()), drive.now()), Verdict::kReset);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_LT(drive.error_m(), 1e-9);
  drive.steps(50);
  EXPECT_EQ(drive.filter.reset(drive.fix(drive.now(), 20, 0), drive.now()), Verdict::kReset);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_NEAR(drive.error_m(), 20, 1e-9);
  EXPECT_EQ(drive.filter.hypotheses().size(), 1u);
  EXPECT_EQ(drive.filter.counters().used, 2u);
}

TEST(PoseFilter, AResetActsAtItsStampAndKeepsOdometrySince) {
  SimulatedDrive drive;
  drive.trust();
  const std::int64_t contact_ns = drive.now();
  drive.steps(20);  // 0.4 m later
  EXPECT_EQ(drive.filter.reset(drive.fix(contact_ns), drive.now()), Verdict::kReset);
  EXPECT_LT(drive.error_m(), 1e-9);
  drive.steps(300);
  EXPECT_EQ(drive.filter.reset(drive.fix(contact_ns), drive.now()), Verdict::kTooOld);
  PoseCorrection wrong = drive.fix(drive.now());
  wrong.sigma_x_m = kNotANumber;
  EXPECT_EQ(drive.filter.reset(wrong, drive.now()), Verdict::kInvalid);
  EXPECT_LT(drive.error_m(), 1e-9);
}

TEST(PoseFilter, AfterAResetOtherFixesMeetItsGate) {
  SimulatedDrive drive;
  drive.trust();
  drive.filter.reset(drive.fix(drive.now()), drive.now());
  drive.steps(10);
  EXPECT_EQ(drive.correct_now(1, 0), Verdict::kOutlier);
  EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
}

}  // namespace
}  // namespace zonepack
