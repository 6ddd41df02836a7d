// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/pose_filter.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <vector>

#include "runtime/odometry/det_math.hpp"

namespace {
bool counting = false;
std::size_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  std::abort();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace zonepack {
namespace {

using Verdict = CorrectionVerdict;

constexpr std::int64_t kMs = 1'000'000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// A robot that drives in arcs at 50 Hz, its odometry exact, and a filter that follows it.
struct Drive {
  explicit Drive(const PoseFilterSettings& settings = {}) : filter(settings) {
    truth.push_back({});
  }

  std::int64_t now() const { return static_cast<std::int64_t>(truth.size() - 1) * 20 * kMs; }
  const Pose2& at(std::int64_t t_ns) const {
    return truth[static_cast<std::size_t>(t_ns / (20 * kMs))];
  }

  void step(double distance_m = 0.02, double turn_rad = 0.01) {
    OdometryIncrement increment;
    increment.from_ns = now();
    const Pose2 motion = along_arc(distance_m, turn_rad);
    truth.push_back(compose(truth.back(), motion));
    increment.to_ns = now();
    increment.motion.pose = motion;
    increment.motion.covariance.xx = 1e-4 * std::abs(distance_m);
    increment.motion.covariance.yy = 2.5e-5 * std::abs(distance_m);
    increment.motion.covariance.yaw_yaw = 4e-4 * std::abs(turn_rad);
    increment.speed_m_s = distance_m / 0.02;
    increment.yaw_rate_rad_s = turn_rad / 0.02;
    filter.predict(increment);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  // A fix of the pose at `stamp`, off by (dx, dy, dyaw).
  PoseCorrection fix(std::int64_t stamp_ns, double dx = 0, double dy = 0, double dyaw = 0) const {
    const Pose2& p = at(stamp_ns);
    return {stamp_ns, now(), {p.x_m + dx, p.y_m + dy, wrap_angle(p.yaw_rad + dyaw)},
            0.03,     0.03,  0.01};
  }
  Verdict correct(std::int64_t stamp_ns, double dx = 0, double dy = 0, double dyaw = 0) {
    return filter.correct(fix(stamp_ns, dx, dy, dyaw), now());
  }
  Verdict correct_now(double dx = 0, double dy = 0, double dyaw = 0) {
    return correct(now(), dx, dy, dyaw);
  }
  void trust() {
    correct_now();
    steps(50);
    correct_now();
    steps(1);
  }
  double error_m() const {
    const Pose2 p = filter.estimate(now()).T_map_base;
    return std::hypot(p.x_m - truth.back().x_m, p.y_m - truth.back().y_m);
  }

  PoseFilter filter;
  std::vector<Pose2> truth;
};

TEST(PoseFilter, KnowsNothingBeforeTheFirstFix) {
  Drive drive;
  drive.steps(10);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).valid);
  EXPECT_TRUE(drive.filter.hypotheses().empty());
}

TEST(PoseFilter, IsTrustedAfterTwoFixesAgreeThroughOdometry) {
  Drive drive;
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
  Drive drive;
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
  Drive drive;
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

TEST(PoseFilter, AGivenStartIsAGuessThatHoldsUntilFixesAgree) {
  Drive drive;
  drive.filter.start_at(0, {}, 0.1, 0.05);
  drive.steps(50);
  EXPECT_TRUE(drive.filter.estimate(drive.now()).valid);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  EXPECT_LT(drive.error_m(), 1e-9);
  // One fix that contradicts does not move the pose, but its place is listed.
  EXPECT_EQ(drive.correct_now(4, 0, 0), Verdict::kHypothesis);
  EXPECT_LT(drive.error_m(), 1e-9);
  EXPECT_EQ(drive.filter.hypotheses().size(), 2u);
  // One that agrees is better than the guess, and is not yet trust.
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(0.05, 0, 0), Verdict::kHypothesis);
  EXPECT_NEAR(drive.error_m(), 0.05, 1e-9);
  EXPECT_FALSE(drive.filter.estimate(drive.now()).trusted);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
}

TEST(PoseFilter, AWrongStartIsOverruledByTwoFixes) {
  Drive drive;
  drive.filter.start_at(0, {10, 10, 2}, 0.1, 0.05);
  drive.steps(50);
  drive.correct_now();
  EXPECT_GT(drive.error_m(), 5);
  drive.steps(50);
  EXPECT_EQ(drive.correct_now(), Verdict::kTrusted);
  EXPECT_LT(drive.error_m(), 1e-9);
}

// What would be the result had the fix not been late: bit for bit.
TEST(PoseFilter, ALateFixActsAtItsStamp) {
  Drive in_time, late;
  in_time.trust();
  late.trust();
  const std::int64_t stamp = in_time.now();
  EXPECT_EQ(in_time.correct(stamp, 0.05, -0.02, 0.01), Verdict::kUsed);
  in_time.steps(60);
  const PoseCorrection fix = late.fix(stamp, 0.05, -0.02, 0.01);
  late.steps(60);
  EXPECT_EQ(late.filter.correct(fix, late.now()), Verdict::kUsed);
  const PoseEstimate a = in_time.filter.estimate(in_time.now());
  const PoseEstimate b = late.filter.estimate(late.now());
  EXPECT_EQ(a.T_map_base, b.T_map_base);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(PoseFilter, FixesThatOvertakeEachOtherGiveTheSameResult) {
  Drive sorted, crossed;
  sorted.trust();
  crossed.trust();
  const std::int64_t first = sorted.now();
  sorted.correct_now(0.04, 0, 0);
  sorted.steps(10);
  crossed.steps(10);
  sorted.correct_now(-0.03, 0.02, 0);
  EXPECT_EQ(crossed.correct_now(-0.03, 0.02, 0), Verdict::kUsed);
  sorted.steps(10);
  crossed.steps(10);
  EXPECT_EQ(crossed.correct(first, 0.04, 0, 0), Verdict::kUsed);
  EXPECT_EQ(sorted.filter.estimate(sorted.now()).T_map_base,
            crossed.filter.estimate(crossed.now()).T_map_base);
}

TEST(PoseFilter, AFixBetweenTwoSamplesIsCarriedAlongTheArc) {
  Drive drive;
  drive.trust();
  drive.step(0.04, 0.1);
  drive.step(0.04, 0.1);
  // The pose in the middle of the last step.
  const Pose2 before = drive.truth[drive.truth.size() - 2];
  const Pose2 middle = compose(before, along_arc(0.02, 0.05));
  const PoseCorrection fix{drive.now() - 10 * kMs, drive.now(), middle, 1e-6, 1e-6, 1e-6};
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kUsed);
  EXPECT_LT(drive.error_m(), 1e-9);
}

TEST(PoseFilter, RefusesFixesOutsideTheGate) {
  Drive drive;
  drive.trust();
  EXPECT_EQ(drive.correct_now(2, 0, 0), Verdict::kOutlier);
  EXPECT_EQ(drive.correct_now(0, 0, 0.5), Verdict::kOutlier);
  EXPECT_EQ(drive.correct_now(0.02, 0.02, 0.005), Verdict::kUsed);
  EXPECT_LT(drive.error_m(), 0.03);
  EXPECT_EQ(drive.filter.counters().outliers, 2u);
}

TEST(PoseFilter, NoFixIsBelievedToBePerfect) {
  Drive drive;
  drive.trust();
  PoseCorrection fix = drive.fix(drive.now());
  fix.sigma_x_m = fix.sigma_y_m = fix.sigma_yaw_rad = 1e-12;
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kUsed);
  const Covariance2 covariance = drive.filter.estimate(drive.now()).covariance;
  EXPECT_GT(std::sqrt(covariance.xx), 0.004);  // 5 mm, and what was known before
  EXPECT_GT(std::sqrt(covariance.yaw_yaw), 0.0009);
}

TEST(PoseFilter, RefusesWhatIsTooOldFromTheFutureOrNotANumber) {
  Drive drive;
  drive.trust();
  drive.steps(300);  // 6 s; the history has 5
  EXPECT_EQ(drive.correct(drive.now() - 5500 * kMs), Verdict::kTooOld);
  PoseCorrection fix = drive.fix(drive.now());
  fix.stamp_ns += 60 * kMs;
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), Verdict::kFromFuture);
  for (const double bad : {kNan, kInf, -kInf}) {
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
  Drive drive;
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
  Drive drive;
  drive.trust();
  drive.steps(100);
  EXPECT_EQ(drive.correct_now(), Verdict::kUsed);
  // Three fixes from before that one come late, and agree on another place.
  for (const int ago_ms : {600, 400, 200}) drive.correct(drive.now() - ago_ms * kMs, 3, 0, 0);
  EXPECT_EQ(drive.filter.counters().reinitialised, 1u);
  EXPECT_NEAR(drive.error_m(), 3, 1e-9);
}

TEST(PoseFilter, RefusedFixesThatDisagreeOrAreInterruptedDoNotMoveThePose) {
  Drive drive;
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

// Trusted in the wrong place, every second fix wrong in its own way: good ones still win.
TEST(PoseFilter, IsNotLockedOutWhileEverySecondFixIsWrong) {
  Drive drive;
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
  Drive drive;
  drive.trust();
  const double before = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  drive.steps(3000);
  const double after = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  EXPECT_GT(after, before * 3);
  EXPECT_EQ(drive.correct_now(2 * after, 0, 0), Verdict::kUsed);
}

TEST(PoseFilter, StaleOdometryGrowsUncertaintyAndLetsTheRobotBeFoundElsewhere) {
  Drive drive;
  drive.trust();
  for (int i = 0; i < 100; ++i) drive.step(0, 0);
  std::int64_t now = drive.now();
  for (int i = 0; i < 1000; ++i) drive.filter.drift_until(now += 10 * kMs);
  const PoseEstimate estimate = drive.filter.estimate(now);
  EXPECT_EQ(estimate.speed_m_s, 0);
  // 0.3 m per root second, 10 s.
  EXPECT_NEAR(position_sigma_m(estimate.covariance), 0.3 * std::sqrt(10.0), 0.02);
  PoseCorrection fix = drive.fix(drive.now(), 1.5, 0, 0);
  fix.stamp_ns = now - 100 * kMs;
  EXPECT_EQ(drive.filter.correct(fix, now), Verdict::kUsed);
}

TEST(PoseFilter, ARobotThatMovedWhenOdometryWentMissingMayBeFarther) {
  Drive drive;
  drive.trust();
  for (int i = 0; i < 100; ++i) drive.step(0.02, 0);  // 1 m/s
  const double before = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  drive.filter.drift_until(drive.now() + 1000 * kMs);
  const PoseEstimate estimate = drive.filter.estimate(drive.now() + 1000 * kMs);
  EXPECT_NEAR(position_sigma_m(estimate.covariance), std::sqrt(1 + 0.09 + before * before), 0.01);
}

// Wheel positions tell after a pause how far the robot went in it; fixes from the pause count, too.
TEST(PoseFilter, TheMotionOfAPauseIsPutWhereItBelongs) {
  for (const bool with_fix : {false, true}) {
    Drive drive;
    drive.trust();
    OdometryIncrement pause;
    pause.from_ns = drive.now();
    pause.motion.pose = along_arc(4 * 0.02 * 50, 4 * 0.01 * 50);
    pause.motion.covariance.xx = pause.motion.covariance.yy = 0.5;
    pause.motion.covariance.yaw_yaw = 0.01;
    for (int i = 1; i <= 200; ++i) {  // 4 s
      drive.truth.push_back(compose(drive.truth.back(), along_arc(0.02, 0.01)));
      drive.filter.drift_until(drive.now());
      if (with_fix && i % 50 == 0) {
        EXPECT_EQ(drive.correct(drive.now() - 140 * kMs), Verdict::kUsed) << i;
      }
    }
    pause.to_ns = drive.now();
    drive.filter.predict(pause);
    EXPECT_LT(drive.error_m(), 1e-6);
    const double sigma = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
    EXPECT_EQ(sigma < 0.5, with_fix) << sigma;
  }
}

TEST(PoseFilter, DoubtFromBeforeTheFirstSampleStays) {
  PoseFilter filter({});
  filter.start_at(0, {}, 0.1, 0.1);
  for (int i = 1; i <= 400; ++i) filter.drift_until(i * 10 * kMs);
  const double before = position_sigma_m(filter.estimate(4000 * kMs).covariance);
  EXPECT_GT(before, 0.5);
  OdometryIncrement first;
  first.from_ns = 4000 * kMs;
  first.to_ns = 4020 * kMs;
  first.motion.pose = {0.02, 0, 0};
  filter.predict(first);
  EXPECT_GE(position_sigma_m(filter.estimate(4020 * kMs).covariance), before);
}

TEST(PoseFilter, TheEstimateIsCarriedOnToNow) {
  Drive drive;
  drive.trust();
  for (int i = 0; i < 200; ++i) drive.step(0.02, 0);
  const Pose2 at_sample = drive.filter.estimate(drive.now()).T_map_base;
  const auto ahead = [&](std::int64_t ms) {
    return between(at_sample, drive.filter.estimate(drive.now() + ms * kMs).T_map_base).x_m;
  };
  EXPECT_NEAR(ahead(10), 0.01, 1e-6);   // 1 m/s
  EXPECT_NEAR(ahead(5000), 0.1, 1e-5);  // no further than 0.1 s
  EXPECT_NEAR(drive.filter.estimate(drive.now()).speed_m_s, 1, 1e-6);
}

TEST(PoseFilter, SurvivesAClockThatWasSetBack) {
  Drive drive;
  drive.trust();
  const Pose2 before = drive.filter.estimate(drive.now()).T_map_base;
  OdometryIncrement increment;
  increment.from_ns = drive.now();
  increment.to_ns = drive.now() - 3'600'000 * kMs;
  drive.filter.predict(increment);
  EXPECT_EQ(drive.filter.estimate(increment.to_ns).T_map_base, before);
  PoseCorrection fix{increment.to_ns, increment.to_ns, before, 0.03, 0.03, 0.01};
  EXPECT_EQ(drive.filter.correct(fix, increment.to_ns), Verdict::kUsed);
}

TEST(PoseFilter, FastOdometrySharesEntriesOfTheHistory) {
  PoseFilterSettings settings;
  settings.history_s = 1;
  PoseFilter filter(settings);
  // 1 kHz: 51 entries of 20 ms hold a second all the same.
  Pose2 pose;
  std::vector<Pose2> truth{pose};
  const auto fix = [&](std::int64_t ms, double sigma) {
    return PoseCorrection{ms * kMs, 0, truth[static_cast<std::size_t>(ms)], sigma, sigma, sigma};
  };
  for (std::int64_t ms = 1; ms <= 3000; ++ms) {
    OdometryIncrement increment;
    increment.from_ns = (ms - 1) * kMs;
    increment.to_ns = ms * kMs;
    increment.motion.pose = along_arc(0.001, 0.0005);
    increment.motion.covariance.xx = 1e-7;
    pose = compose(pose, increment.motion.pose);
    truth.push_back(pose);
    filter.predict(increment);
    if (ms == 1007 || ms == 2013) filter.correct(fix(ms, 0.03), ms * kMs);
  }
  EXPECT_TRUE(filter.estimate(3000 * kMs).trusted);
  EXPECT_EQ(filter.correct(fix(2100, 0.03), 3000 * kMs), Verdict::kUsed);
  EXPECT_EQ(filter.correct(fix(1500, 0.03), 3000 * kMs), Verdict::kTooOld);
  EXPECT_NEAR(filter.estimate(3000 * kMs).T_map_base.x_m, pose.x_m, 1e-6);
}

// Noisy odometry and fixes as the model says: the squared error over its covariance has mean 3.
TEST(PoseFilter, ItsUncertaintyIsHonest) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  double sum = 0;
  int count = 0;
  for (int run = 0; run < 40; ++run) {
    PoseFilter filter({});
    Pose2 truth;
    for (int i = 1; i <= 1500; ++i) {
      OdometryIncrement increment;
      increment.from_ns = (i - 1) * 20 * kMs;
      increment.to_ns = i * 20 * kMs;
      const double turn = 0.02 * std::sin(i * 0.01);
      Covariance2& noise = increment.motion.covariance;
      noise.xx = 1e-4 * 0.02, noise.yy = 2.5e-5 * 0.02, noise.yaw_yaw = 1e-4 * 0.02;
      const Pose2 motion = along_arc(0.02, turn);
      increment.motion.pose = {motion.x_m + std::sqrt(noise.xx) * normal(random),
                               motion.y_m + std::sqrt(noise.yy) * normal(random),
                               motion.yaw_rad + std::sqrt(noise.yaw_yaw) * normal(random)};
      truth = compose(truth, motion);
      filter.predict(increment);
      if (i % 50 == 0) {
        filter.correct({i * 20 * kMs,
                        0,
                        {truth.x_m + 0.03 * normal(random), truth.y_m + 0.03 * normal(random),
                         truth.yaw_rad + 0.01 * normal(random)},
                        0.03,
                        0.03,
                        0.01},
                       i * 20 * kMs);
      }
      if (i > 300 && i % 25 == 0) {
        const PoseEstimate e = filter.estimate(i * 20 * kMs);
        sum += mahalanobis2({e.T_map_base, e.covariance}, {truth, {}});
        ++count;
      }
    }
  }
  EXPECT_NEAR(sum / count, 3, 0.35);
}

TEST(PoseFilter, TakesNoMemoryAfterConstruction) {
  Drive drive;
  drive.truth.reserve(4000);
  counting = true;
  allocations = 0;
  drive.filter.start_at(0, {});
  for (int i = 0; i < 60; ++i) {
    drive.steps(50);
    drive.correct_now(i % 7 == 0 ? 3 : 0, 0, 0);
  }
  drive.filter.drift_until(drive.now() + 1000 * kMs);
  counting = false;
  EXPECT_EQ(allocations, 0u);
}

// The whole chain decides the same on every CPU and compiler: bits of the estimates of a noisy
// drive.
TEST(PoseFilter, GivesTheSameBitsEverywhere) {
  std::mt19937_64 random(31);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  PoseFilterSettings settings;
  settings.gate_chi2 = 16.27;
  settings.speed_filter_s = 0.1;
  Drive drive(settings);
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto mix = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3u;
  };
  for (int i = 1; i <= 5000; ++i) {
    const double distance = 0.01 + 0.01 * unit();
    const double turn = 0.03 * unit();
    drive.step(distance, turn);
    if (i % 50 == 0) {
      const double off = i % 350 == 0 ? 3 : 0.05;
      const double dx = off * unit();
      const double dy = off * unit();
      const double dyaw = 0.02 * unit();
      drive.correct(drive.now() - 140 * kMs, dx, dy, dyaw);
    }
    const PoseEstimate e = drive.filter.estimate(drive.now() + 7 * kMs);
    mix(e.T_map_base.x_m), mix(e.T_map_base.y_m), mix(e.T_map_base.yaw_rad);
    mix(e.covariance.xx), mix(e.covariance.x_yaw), mix(e.covariance.yaw_yaw);
  }
  EXPECT_GT(drive.filter.counters().outliers, 10u);
  EXPECT_EQ(hash, 0x713c4511a2a05b22u);
}

// Any input at all: the estimate stays finite and the covariance positive.
TEST(PoseFilter, StaysFiniteUnderRandomInput) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(-1, 1);
  PoseFilterSettings settings;
  settings.history_s = 0.5;
  PoseFilter filter(settings);
  std::int64_t now = 0;
  for (int i = 0; i < 50'000; ++i) {
    now += static_cast<std::int64_t>(random() % 40) * kMs;
    switch (random() % 8) {
      case 0: {
        PoseCorrection fix{now - static_cast<std::int64_t>(random() % 800) * kMs,
                           now,
                           {unit(random) * 3, unit(random) * 3, unit(random) * 7},
                           0.1,
                           0.1,
                           0.1};
        if (random() % 20 == 0) fix.sigma_x_m = std::pow(10.0, unit(random) * 12);
        filter.correct(fix, now);
        break;
      }
      case 1:
        filter.drift_until(now);
        break;
      case 2:
        if (random() % 50 == 0) filter.start_at(now, {unit(random), unit(random), unit(random)});
        break;
      default: {
        OdometryIncrement step;
        step.from_ns = now - 20 * kMs;
        step.to_ns = now + static_cast<std::int64_t>(random() % 60) * kMs - 30 * kMs;
        step.motion.pose = along_arc(unit(random) * 0.1, unit(random) * 0.5);
        step.motion.covariance.xx = step.motion.covariance.yy = 1e-6;
        filter.predict(step);
      }
    }
    const PoseEstimate e = filter.estimate(now);
    if (!e.valid) continue;
    ASSERT_TRUE(is_finite(e.T_map_base)) << i;
    ASSERT_GE(e.covariance.xx, 0) << i;
    ASSERT_GE(e.covariance.yaw_yaw, 0) << i;
    ASSERT_LE(filter.hypotheses().size(), kMaxHypotheses);
  }
}

}  // namespace
}  // namespace zonepack
