// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace zonepack {
namespace {

class CanLog : public testing::Test {
 protected:
  ~CanLog() override { ::unlink(path_.c_str()); }

  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  std::string path_ = testing::TempDir() + "can_log_" + std::to_string(::getpid()) + ".log";
};

std::vector<std::uint32_t> ids(CanLogReader& reader) {
  std::vector<std::uint32_t> found;
  while (const auto frame = reader.next()) found.push_back(frame->id);
  return found;
}

TEST_F(CanLog, CountsAndNamesBrokenLinesAndReadsTheRest) {
  write(
      "(1718021600.000000) can0 001#00\r\n"
      "\n"
      "(1718021600.0100) can0 002#0\n"
      "# a note\n"
      "DROPCOUNT: dropped 5 CAN frames on 'can0' socket (total drops 5)\n"
      "(1718021600.020000) can0 20000004#0004000000000000\n"
      "what is this\n"
      "(1718021600.030000) can0 003#00");
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  EXPECT_EQ(reader.next()->id, 1u);
  EXPECT_EQ(reader.dropped(), 0u);
  EXPECT_TRUE(reader.next()->error);
  EXPECT_EQ(reader.dropped(), 5u);
  EXPECT_EQ(reader.next()->id, 3u);
  EXPECT_FALSE(reader.next().has_value());
  EXPECT_FALSE(reader.next().has_value());
  const CanLogSummary& summary = reader.summary();
  EXPECT_EQ(summary.lines, 8u);
  EXPECT_EQ(summary.frames, 3u);
  EXPECT_EQ(summary.broken_lines, 2u);
  EXPECT_EQ(summary.error_frames, 1u);
  EXPECT_EQ(summary.dropped, 5u);
  ASSERT_EQ(summary.faults.size(), 2u);
  EXPECT_EQ(summary.faults[0].line, 3u);
  EXPECT_NE(summary.faults[0].what.find("(1718021600.0100) can0 002#0"), std::string::npos);
  EXPECT_EQ(summary.faults[1].line, 7u);
}

TEST_F(CanLog, GivesOnlyTheWantedInterface) {
  write("(1.0) can0 001#\n(1.1) can1 002#\n(1.2) can0 003#\n");
  CanLogReader one(path_, "can0");
  ASSERT_TRUE(one.open().ok());
  EXPECT_EQ(ids(one), (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(one.summary().other_interfaces, 1u);
  CanLogReader all(path_);
  ASSERT_TRUE(all.open().ok());
  EXPECT_EQ(ids(all), (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST_F(CanLog, TakesARecordingOfOneOtherBusAsTheWantedOne) {
  write("(1.0) vcan7 001#\n(1.2) vcan7 003#\n");
  CanLogReader reader(path_, "can0");
  ASSERT_TRUE(reader.open().ok());
  EXPECT_EQ(reader.summary().interface, "vcan7");
  EXPECT_EQ(ids(reader), (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(reader.summary().lines, 2u);
}

TEST_F(CanLog, KeepsTheOrderOfTheFileAndCountsStampsThatStepBack) {
  write(
      "(10.0) can0 001#\n(10.3) can0 002#\n(10.1) can0 003#\n(10.2) can0 004#\n(10.4) can0 005#\n");
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  EXPECT_EQ(ids(reader), (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
  EXPECT_EQ(reader.summary().unsorted_stamps, 2u);  // 10.1 and 10.2 after 10.3
}

TEST_F(CanLog, LeavesOutASingleStampFarInTheFuture) {
  write("(10.0) can0 001#\n(9999.0) can0 002#\n(10.1) can0 003#\n(8000.0) can0 004#\n");
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  // 004 comes over two hours after its predecessor, but nothing says that it is wrong.
  EXPECT_EQ(ids(reader), (std::vector<std::uint32_t>{1, 3, 4}));
  EXPECT_EQ(reader.summary().stray_stamps, 1u);
  EXPECT_EQ(reader.summary().faults.at(0).line, 2u);
  EXPECT_EQ(reader.summary().unsorted_stamps, 0u);
}

// A clock that starts in 1970 and is set, one that is set back by hours, and one that is set by
// seconds: frames keep coming at their period of 20 ms, pairs 0.2 ms apart.
TEST_F(CanLog, BridgesTheStepsOfItsClock) {
  struct Case {
    double from_s, to_s;
  };
  for (const auto& [from_s, to_s] : {Case{10, 1718021606}, Case{1718021606, 10},
                                     Case{20'000, 9'000}, Case{100, 97}, Case{100, 112}}) {
    std::string text;
    for (int i = 0; i < 200; ++i) {
      const double s = (i < 100 ? from_s : to_s) + i * 0.02;
      char line[160];
      std::snprintf(line, sizeof line, "(%.6f) can0 221#00\n(%.6f) can0 311#00\n", s, s + 0.0002);
      text += line;
    }
    write(text);
    CanLogReader reader(path_);
    ASSERT_TRUE(reader.open().ok());
    const auto start_ns = static_cast<std::int64_t>(from_s * 1e9);
    for (int i = 0; i < 200; ++i) {
      EXPECT_NEAR(static_cast<double>(reader.next()->stamp_ns - start_ns), i * 2e7, 2000) << i;
      EXPECT_NEAR(static_cast<double>(reader.next()->stamp_ns - start_ns), i * 2e7 + 2e5, 2000);
    }
    const CanLogSummary& summary = reader.summary();
    EXPECT_EQ(summary.clock_steps, 1u) << from_s << " to " << to_s;
    ASSERT_EQ(summary.steps.size(), 1u);
    EXPECT_EQ(summary.steps[0].line, 201u);
    EXPECT_NEAR(static_cast<double>(summary.steps[0].before_ns), (from_s + 1.9802) * 1e9, 2000);
    EXPECT_NEAR(static_cast<double>(summary.steps[0].after_ns), (to_s + 2) * 1e9, 2000);
    EXPECT_EQ(summary.unsorted_stamps + summary.stray_stamps, 0u);
  }
}

TEST_F(CanLog, TakesSilenceForSilenceAndOneEarlyStampForDisorder) {
  write("(10.0) can0 001#\n(19.9) can0 002#\n(12.0) can0 003#\n(20.0) can0 004#\n");
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  for (const double s : {10.0, 19.9, 12.0, 20.0}) {
    EXPECT_EQ(reader.next()->stamp_ns, static_cast<std::int64_t>(s * 1e9));
  }
  EXPECT_EQ(reader.summary().clock_steps, 0u);
  EXPECT_EQ(reader.summary().unsorted_stamps, 1u);
}

TEST_F(CanLog, BoundsWhatItKeepsOfAClockThatIsSetAgainAndAgain) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) {
    const std::string second = std::to_string(i / 10 % 2 == 0 ? 100 : 2'000'000'000);
    text += "(" + second + "." + std::to_string(i % 10) + ") can0 001#00\n";
  }
  write(text);
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  std::int64_t last_ns = 0;
  while (const auto frame = reader.next()) {
    EXPECT_GE(frame->stamp_ns, last_ns);
    last_ns = frame->stamp_ns;
  }
  EXPECT_EQ(last_ns, 100'000'000'000 + 9'999 * 100'000'000LL);  // at their period of 0.1 s
  EXPECT_EQ(reader.summary().clock_steps, 999u);
  EXPECT_EQ(reader.summary().steps.size(), CanLogReader::kMostFaults);
}

TEST_F(CanLog, ReadsStampsFromZeroAndRefusesTimeDifferences) {
  std::string from_zero;
  std::string differences;
  for (int i = 0; i < 20; ++i) {
    const std::string rest = ")  can0  311   [1]  00\n";
    from_zero += " (000." + std::to_string(100000 + i * 10000) + rest;
    differences += std::string(" (000.") + (i % 2 == 0 ? "000200" : "019800") + rest;
  }
  write(from_zero);
  CanLogReader good(path_);
  EXPECT_TRUE(good.open().ok());
  EXPECT_EQ(ids(good).size(), 20u);
  write(differences);
  CanLogReader bad(path_);
  const Result<void> opened = bad.open();
  EXPECT_EQ(opened.error().code, ErrorCode::kBadValue);
  EXPECT_NE(bad.explain(opened.error()).find("-td"), std::string::npos);
}

TEST_F(CanLog, RefusesAFileWithoutAFrameAndSaysWhatItExpected) {
  for (const char* text : {"", "\n\n", "PK\x03\x04", "  can0  311   [1]  00\n"}) {
    write(text);
    CanLogReader reader(path_);
    const Result<void> opened = reader.open();
    EXPECT_EQ(opened.error().code, ErrorCode::kBadStructure);
    EXPECT_NE(reader.explain(opened.error()).find("can0 311#"), std::string::npos);
  }
  write("(1.0) can1 001#\n(1.0) can2 001#\n");
  CanLogReader filtered(path_, "can0");
  const Result<void> opened = filtered.open();
  EXPECT_NE(filtered.explain(opened.error()).find("other interfaces than can0"), std::string::npos);
  CanLogReader absent(path_ + ".absent");
  EXPECT_EQ(absent.open().error().code, ErrorCode::kNotFound);
  CanLogReader folder(testing::TempDir());
  EXPECT_EQ(folder.open().error().code, ErrorCode::kIo);
}

TEST_F(CanLog, BoundsItsMemoryWhateverTheFile) {
  write(std::string(3'000'000, 'x') + "\n(1.0) can0 001#\n" + std::string(100, '\n') +
        std::string(5'000'000, '\0'));
  CanLogReader reader(path_);
  ASSERT_TRUE(reader.open().ok());
  EXPECT_EQ(ids(reader), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(reader.summary().broken_lines, 2u);
  EXPECT_LT(reader.summary().faults.at(0).what.size(), 200u);
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "broken\n(1.0) can0 001#\n";
  write(many);
  CanLogReader second(path_);
  ASSERT_TRUE(second.open().ok());
  EXPECT_EQ(ids(second).size(), 1000u);
  EXPECT_EQ(second.summary().broken_lines, 1000u);
  EXPECT_EQ(second.summary().faults.size(), CanLogReader::kMostFaults);
}

}  // namespace
}  // namespace zonepack
