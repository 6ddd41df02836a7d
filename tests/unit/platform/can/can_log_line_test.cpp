// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log_line.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace zonepack {
namespace {

using Kind = CanLogLine::Kind;

std::vector<int> bytes(const CanFrame& frame) {
  return {frame.data.begin(), frame.data.begin() + (frame.rtr ? 0 : frame.len)};
}

CanFrame frame_of(std::string_view text) {
  const CanLogLine line = parse_can_log_line(text);
  EXPECT_EQ(line.kind, Kind::kFrame) << text << ": " << (line.fault ? line.fault : "");
  return line.frame;
}

const std::vector<int> kFive = {0x2A, 0x36, 0x6C, 0x2B, 0xBA};

TEST(CanLogLine, ReadsTheLogFormat) {
  const CanLogLine line = parse_can_log_line("(1436509052.249713) can0 044#2A366C2BBA");
  ASSERT_EQ(line.kind, Kind::kFrame);
  EXPECT_EQ(line.interface, "can0");
  EXPECT_TRUE(line.absolute_stamp);
  EXPECT_EQ(line.frame.stamp_ns, 1'436'509'052'249'713'000);
  EXPECT_EQ(line.frame.id, 0x044u);
  EXPECT_FALSE(line.frame.extended || line.frame.fd || line.frame.rtr || line.frame.error);
  EXPECT_EQ(bytes(line.frame), kFive);
}

TEST(CanLogLine, ReadsNanosecondsDirectionLettersDotsAndLineEnds) {
  EXPECT_EQ(frame_of("(1436509052.249713123) can0 044#2A").stamp_ns, 1'436'509'052'249'713'123);
  EXPECT_EQ(frame_of("(1436509052.2) can0 044#2A").stamp_ns, 1'436'509'052'200'000'000);
  for (const char* text :
       {"(1436509052.249713) can0 044#2A366C2BBA R", "(1436509052.249713) can0 044#2A366C2BBA T",
        "(1436509052.249713) can0 044#2A366C2BBA\r",
        "  (1436509052.249713)  can0  044#2a366c2bba  ",
        "(1436509052.249713) can0 044#2A.36.6C.2B.BA"}) {
    EXPECT_EQ(bytes(frame_of(text)), kFive) << text;
  }
}

TEST(CanLogLine, ReadsExtendedIdsRemoteRequestsAndErrorFrames) {
  EXPECT_TRUE(frame_of("(1.0) can0 12345678#00").extended);
  EXPECT_EQ(frame_of("(1.0) can0 12345678#00").id, 0x12345678u);
  EXPECT_TRUE(frame_of("(1.0) can0 00000123#00").extended);
  EXPECT_TRUE(frame_of("(1.0) can0 123#R").rtr);
  EXPECT_EQ(frame_of("(1.0) can0 123#R").len, 0);
  EXPECT_EQ(frame_of("(1.0) can0 12345678#R8").len, 8);
  const CanFrame error = frame_of("(1.0) can0 20000004#0004000000000000");
  EXPECT_TRUE(error.error);
  EXPECT_FALSE(error.extended);
  EXPECT_EQ(error.id, 0x4u);
}

TEST(CanLogLine, ReadsFdFramesAndRawDlc) {
  const CanFrame fd = frame_of("(1.0) can0 123##1112233445566778899AABBCC");
  EXPECT_TRUE(fd.fd);
  EXPECT_EQ(fd.flags, 1);
  EXPECT_EQ(fd.len, 12);
  EXPECT_EQ(fd.data[11], 0xCC);
  EXPECT_EQ(frame_of("(1.0) can0 123##0").len, 0);
  EXPECT_EQ(frame_of("(1.0) can0 123##3." + std::string(128, '5')).len, 64);
  EXPECT_EQ(frame_of("(1.0) can0 123#1122334455667788_E").len, 8);
  EXPECT_EQ(frame_of("(1.0) can0 123#R8_9").len, 8);
}

// Lines as candump -ta prints them, without and with -a, -x, -e, -i, -S, -c.
TEST(CanLogLine, ReadsTheScreenFormat) {
  for (const char* text :
       {" (1436509052.249713)  can0  044   [5]  2A 36 6C 2B BA",
        " (1436509052.249713)  can0       044   [5]  2A 36 6C 2B BA            '*6l+.'",
        " (1436509052.249713)  can0  RX - -  044   [5]  2A 36 6C 2B BA",
        " (1436509052.249713)  can0  044   [5]  BA`2B`6C`36`2A            `.+l6*`",
        " (1436509052.249713)  can0  044   [5]  00101010 00110110 01101100 00101011 10111010",
        "\x1b[31m (1436509052.249713)  can0  044   [5]  2A 36 6C 2B BA\x1b[0m"}) {
    const CanFrame frame = frame_of(text);
    EXPECT_EQ(frame.id, 0x044u) << text;
    EXPECT_EQ(frame.stamp_ns, 1'436'509'052'249'713'000) << text;
    EXPECT_EQ(bytes(frame), kFive) << text;
  }
  const CanFrame fd =
      frame_of("(1.0)  can0  TX B E       123  [12]  11 22 33 44 55 66 77 88 99 AA BB CC");
  EXPECT_TRUE(fd.fd);
  EXPECT_EQ(fd.flags, 3);
  EXPECT_EQ(fd.len, 12);
  EXPECT_TRUE(frame_of("(1.0)  can0  12345678   [0]  remote request").rtr);
  EXPECT_TRUE(frame_of("(1.0)  can0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME").error);
  EXPECT_EQ(frame_of("(1.0)  can0  123   {B}  11 22 33 44 55 66 77 88").len, 8);
  EXPECT_EQ(frame_of("(1.0)  can0  123   [0]").len, 0);
}

TEST(CanLogLine, DistinguishesAbsoluteStampsFromRelativeOnes) {
  EXPECT_FALSE(parse_can_log_line(" (000.000200)  can0  311   [1]  00").absolute_stamp);
  EXPECT_FALSE(parse_can_log_line(" (12345.000200)  can0  311   [1]  00").absolute_stamp);
  // date -u -d @1718021600 = 2024-06-10 12:13:20
  const CanLogLine dated = parse_can_log_line(" (2024-06-10 12:13:20.001102)  can0  311   [1]  00");
  EXPECT_TRUE(dated.absolute_stamp);
  EXPECT_EQ(dated.frame.stamp_ns, 1'718'021'600'001'102'000);
}

TEST(CanLogLine, PassesOverWhatHoldsNoFrame) {
  for (const char* text :
       {"", "   ", "\r", "# a comment", "; a comment", "\tcontroller-problem{rx-overflow}",
        "\t\ttext of candump -e", "\x1b[31"}) {
    EXPECT_EQ(parse_can_log_line(text).kind, Kind::kNothing) << text;
  }
  const CanLogLine drop =
      parse_can_log_line("DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 7)");
  EXPECT_EQ(drop.kind, Kind::kDrop);
  EXPECT_EQ(drop.dropped, 3u);
}

TEST(CanLogLine, NamesTheFaultOfABrokenLine) {
  for (const char* text : {"can0 311#00",
                           "  can0  311   [1]  00",
                           "hello",
                           "(",
                           "(1)",
                           "(1.5",
                           "(1.5)",
                           "(1.5) can0",
                           "(1.) can0 311#00",
                           "(.5) can0 311#00",
                           "(-1.5) can0 311#00",
                           "(1.1234567890) can0 311#00",
                           "(9999999999999.0) can0 311#00",
                           "(99999999999999999999.0) can0 311#00",
                           "(a.b) can0 311#00",
                           "(2024-13-10 12:13:20.0) can0 311#00",
                           "(1.5) can0 31#00",
                           "(1.5) can0 3111#00",
                           "(1.5) can0 31G#00",
                           "(1.5) can0 800#00",
                           "(1.5) can0 40000123#00",
                           "(1.5) can0 311#0",
                           "(1.5) can0 311#0G",
                           "(1.5) can0 311#001122334455667788",
                           "(1.5) can0 311#00 garbage",
                           "(1.5) can0 311#00 R R",
                           "(1.5) can0 311##",
                           "(1.5) can0 311##G",
                           "(1.5) can0 311#R9",
                           "(1.5) can0 311#00_9",
                           "(1.5) can0 311#0011223344556677_8",
                           "(1.5)  can0  311   [2]  00",
                           "(1.5)  can0  311   [9]  00",
                           "(1.5)  can0  311   [65]  00",
                           "(1.5)  can0  311   8  00",
                           "(1.5)  can0  311   [1]  0",
                           "(1.5)  can0  311   [1]  000",
                           "(1.5) can0 45#80:00:12345678#00",
                           "DROPCOUNT: many",
                           "DROPCOUNT"}) {
    const CanLogLine line = parse_can_log_line(text);
    EXPECT_EQ(line.kind, Kind::kBroken) << text;
    EXPECT_NE(line.fault, nullptr) << text;
  }
}

TEST(CanLogLine, SurvivesEveryCutAndEveryFlippedBitOfALine) {
  const std::vector<std::string> lines = {
      "(1436509052.249713) can0 12345678##1112233445566778899AABBCC R",
      " (2024-06-10 12:13:20.001102)  can0  RX B -  044   [5]  BA`2B`6C`36`2A   `.+l6*`",
      "DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 7)"};
  for (const std::string& text : lines) {
    for (std::size_t size = 0; size < text.size(); ++size) {
      const CanLogLine line = parse_can_log_line(text.substr(0, size));
      EXPECT_EQ(line.kind == Kind::kBroken, line.fault != nullptr);
    }
    for (std::size_t bit = 0; bit < text.size() * 8; ++bit) {
      std::string flipped = text;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      const CanLogLine line = parse_can_log_line(flipped);
      EXPECT_LE(line.frame.len, 64);
      EXPECT_EQ(line.kind == Kind::kBroken, line.fault != nullptr);
    }
  }
}

}  // namespace
}  // namespace zonepack
