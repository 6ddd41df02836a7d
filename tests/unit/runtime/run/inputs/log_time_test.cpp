// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/log_time.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class LogTimeOf : public testing::Test {
 protected:
  // Frames every second: `seconds` of them from each stamp on.
  LogTime read(const std::vector<std::int64_t>& from_s, std::int64_t seconds) {
    std::ofstream log(folder / "drive.log");
    for (const std::int64_t from : from_s) {
      for (std::int64_t s = from; s < from + seconds; ++s) log << "(" << s << ".0) can0 001#00\n";
    }
    log.close();
    return LogTime::read(folder / "drive.log", "");
  }
  test_support::TemporaryFolder folder;
};

TEST_F(LogTimeOf, PutsPosesOnTheClockOfTheFirstFrame) {
  // 10 to 19 s, then 1718021600 s: the frame after 19 comes at 20, which adds 20 - 1718021600 s.
  const LogTime time = read({10, 1'718'021'600}, 10);
  EXPECT_TRUE(time.steps());
  const auto on_first_s = [&](std::int64_t s) {
    return time.on_first_clock(s * kSecond_ns) / kSecond_ns;
  };
  EXPECT_EQ(on_first_s(12), 12);
  EXPECT_EQ(on_first_s(1'718'021'600), 20);
  EXPECT_EQ(on_first_s(1'718'021'609), 29);
  EXPECT_EQ(on_first_s(21), 21) << "next to what was before the step";
  EXPECT_EQ(on_first_s(1'718'021'592), 12) << "from a clock that was right all the time";

  std::vector<PoseCorrection> corrections(2);
  corrections[0].stamp_ns = corrections[0].received_ns = 1'718'021'601 * kSecond_ns;
  corrections[1].stamp_ns = corrections[1].received_ns = 1'718'021'590 * kSecond_ns;
  const auto placed = time.on_first_clock(corrections);
  EXPECT_EQ(placed[0].received_ns, 10 * kSecond_ns) << "in order of reception";
  EXPECT_EQ(placed[1].stamp_ns, 21 * kSecond_ns);

  const TruthTrack truth({{12 * kSecond_ns, {1, 0, 0}}, {1'718'021'602 * kSecond_ns, {11, 0, 0}}});
  EXPECT_DOUBLE_EQ(time.on_first_clock(truth).at(17 * kSecond_ns)->x_m, 6);
}

TEST_F(LogTimeOf, FollowsAClockThatIsSetBack) {
  const LogTime time = read({1'718'021'600, 10}, 10);
  EXPECT_EQ(time.on_first_clock(15 * kSecond_ns), 1'718'021'615 * kSecond_ns);
}

// 100 to 129 s, then set back to 110: the order of the file says which 115 is meant.
TEST_F(LogTimeOf, TellsStampsApartThatAClockGaveTwice) {
  const LogTime time = read({100, 110}, 30);
  std::vector<PoseCorrection> corrections(4);
  const std::int64_t received_s[] = {115, 128, 111, 115};
  for (std::size_t i = 0; i < 4; ++i) {
    corrections[i].received_ns = received_s[i] * kSecond_ns;
    corrections[i].stamp_ns = corrections[i].received_ns - kSecond_ns / 2;
  }
  const auto placed = time.on_first_clock(corrections);
  // The frame stamped 110 comes at 130: what follows it is 20 s later than written.
  const std::int64_t expected_s[] = {115, 128, 131, 135};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(placed[i].received_ns, expected_s[i] * kSecond_ns) << i;
    EXPECT_EQ(placed[i].stamp_ns, expected_s[i] * kSecond_ns - kSecond_ns / 2) << i;
  }
}

TEST_F(LogTimeOf, ChangesNothingWithoutAStep) {
  const LogTime time = read({10}, 10);
  EXPECT_FALSE(time.steps());
  EXPECT_EQ(time.on_first_clock(12'345), 12'345);
  EXPECT_EQ(LogTime::read(folder / "absent", "").on_first_clock(7), 7);
}

}  // namespace
}  // namespace zonepack
