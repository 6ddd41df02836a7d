// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/log_match.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "runtime/run/inputs/rejected_text.hpp"

namespace zonepack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class FrameList final : public CanFrameSource {
 public:
  explicit FrameList(std::vector<CanFrame> frames) : frames_(std::move(frames)) {}
  std::optional<CanFrame> next() noexcept override {
    return at_ < frames_.size() ? std::optional(frames_[at_++]) : std::nullopt;
  }

 private:
  std::vector<CanFrame> frames_;
  std::size_t at_ = 0;
};

CanFrame frame(std::uint32_t id, bool extended, std::int64_t stamp_ns) {
  CanFrame made;
  made.id = id;
  made.extended = extended;
  made.stamp_ns = stamp_ns;
  return made;
}

WheelOdometrySettings reading(std::uint32_t left, std::uint32_t right) {
  WheelOdometrySettings settings;
  settings.signals[0].id = left;
  settings.signals[1].id = right;
  return settings;
}

TEST(LogMatch, SaysWhatTheLogHoldsInsteadOfWhatOdometryReads) {
  FrameList list({frame(0x123, true, 2'000'000'000), frame(0x123, true, 1'000'000'000),
                  frame(0x7, false, 4'500'000'000)});
  LogMatch match(list);
  while (match.next()) continue;
  CanLogSummary summary;
  EXPECT_THAT(match.mismatch(reading(0x123, 0x123), "drive.log", summary),
              AllOf(HasSubstr("drive.log: holds none of the frames that odometry reads: expected "
                              "0x123 (11 bits)"),
                    HasSubstr("came with a 29-bit id 2 times: write extended: true"),
                    HasSubstr("the log has 0x00000123 (29 bits) 2 times, 0x007 (11 bits) 1 time;"),
                    Not(HasSubstr("interfaces"))));
  EXPECT_THAT(match.mismatch(reading(0x7, 0x8), "drive.log", summary),
              HasSubstr("lacks frames that odometry reads: expected 0x008 (11 bits); the log"));
  EXPECT_EQ(match.mismatch(reading(0x7, 0x7), "drive.log", summary), "");
  summary.interface = "can0";
  summary.other_interfaces = 5;
  summary.other_names = "can1, vcan0";
  EXPECT_THAT(match.mismatch(reading(0x8, 0x8), "drive.log", summary),
              HasSubstr("5 frames are of other interfaces than can0: can1, vcan0"));
}

TEST(LogMatch, FilesThatDoNotOverlapTheLogFailWithBothRanges) {
  FrameList list({frame(1, false, 1'000'000'000), frame(1, false, 3'000'000'000)});
  LogMatch match(list);
  while (match.next()) continue;
  EXPECT_TRUE(check_overlap("t.txt", 3'000'000'000, 4'000'000'000, "a.log", match).ok());
  const auto apart = check_overlap("t.txt", 3'500'000'000, 4'000'000'000, "a.log", match);
  ASSERT_FALSE(apart.ok());
  EXPECT_THAT(
      apart.error().message,
      HasSubstr("t.txt: covers 3.500 to 4.000 s, and a.log 1.000 to 3.000 s: nothing of it"));
  EXPECT_FALSE(check_overlap("t.txt", 0, 999'999'999, "a.log", match).ok());
}

TEST(RejectedText, NamesEachReasonWithItsCountAndLimit) {
  WheelOdometryCounters counters;
  counters.rejected = 358;
  counters.jumps = 315;
  counters.too_fast = 312;
  counters.not_newer = 40;
  counters.unreadable = 3;
  EXPECT_EQ(rejected_text(counters, {}),
            "312 above max_speed 3 m/s or max_yaw_rate 6 rad/s, 3 above max_acceleration 10 m/s2, "
            "40 not newer than the one before, 3 too short, remote requests or not finite");
  EXPECT_EQ(rejected_text(WheelOdometryCounters(), {}), "");
  PoseFilterCounters fixes;
  fixes.too_old = 2;
  EXPECT_EQ(rejected_text(fixes), "2 too old");
}

}  // namespace
}  // namespace zonepack
