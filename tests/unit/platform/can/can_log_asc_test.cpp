// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log_asc.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "platform/can/can_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

class AscLog : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string refusal(const std::string& path) const {
    CanLogReader reader(path);
    const auto opened = reader.open();
    EXPECT_FALSE(opened.ok());
    return opened.ok() ? "" : reader.explain(opened.error());
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(AscLog, GivesFramesOfAllKindsWithTheirStamps) {
  CanLogReader reader(
      write("a.asc",
            "date Sat Jan 24 03:09:15.88 pm 2026\r\n"
            "base hex  timestamps absolute\r\n"
            "internal events logged\r\n"
            "// version 9.0.0\r\n"
            "Begin Triggerblock Sat Jan 24 03:09:15.88 pm 2026\r\n"
            "   0.000000 Start of measurement\r\n"
            "   0.010000 CAN 1 Status:chip status error active\r\n"
            "   0.120000 1  311             Rx   d 8 00 00 40 DB 00 01 5B CF  Length = 1\r\n"
            "   0.220000 1  18FEF1FEx       Tx   d 2 01 02\r\n"
            "   0.320000 1  7FF             Rx   r\r\n"
            "   0.330000 1  Statistic: D 1 R 0\r\n"
            "   0.420000 CANFD   1 Rx 123 1 0 9 12 00 01 02 03 04 05 06 07 08 09 0A 0B 0 0\r\n"
            "   0.520000 1  12              Rx   d 2 01\r\n"
            "End TriggerBlock\r\n"));
  ASSERT_TRUE(reader.open().ok());
  // 2026-01-24 15:09:15.88 UTC.
  constexpr std::int64_t kStart_ns = 1'769'267'355'880'000'000;
  const auto odometer = reader.next();
  ASSERT_TRUE(odometer);
  EXPECT_EQ(odometer->id, 0x311u);
  EXPECT_EQ(odometer->len, 8);
  EXPECT_EQ(odometer->data[3], 0xDB);
  EXPECT_EQ(odometer->stamp_ns, kStart_ns + 120'000'000);
  const auto extended = reader.next();
  ASSERT_TRUE(extended);
  EXPECT_TRUE(extended->extended);
  EXPECT_EQ(extended->id, 0x18FEF1FEu);
  const auto remote = reader.next();
  ASSERT_TRUE(remote);
  EXPECT_TRUE(remote->rtr);
  const auto fd = reader.next();
  ASSERT_TRUE(fd);
  EXPECT_TRUE(fd->fd);
  EXPECT_EQ(fd->len, 12);
  EXPECT_EQ(fd->data[11], 0x0B);
  EXPECT_FALSE(reader.next());
  ASSERT_EQ(reader.summary().broken_lines, 1u);
  EXPECT_EQ(reader.summary().faults[0].line, 13u);
}

TEST_F(AscLog, ReadsDecimalNumbersDifferencesAndChannels) {
  const std::string path = write("b.asc",
                                 "date nothing known\n"
                                 "base dec  timestamps relative\n"
                                 "0.5 1 291 Rx d 1 255\n"
                                 "0.5 2 292 Rx d 1 1\n"
                                 "0.5 1 293 Rx d 1 2\n");
  CanLogReader first(path, "can0");
  ASSERT_TRUE(first.open().ok());
  const auto a = first.next();
  ASSERT_TRUE(a);
  EXPECT_EQ(a->id, 291u);
  EXPECT_EQ(a->data[0], 255);
  EXPECT_EQ(a->stamp_ns, 500'000'000);
  const auto b = first.next();
  ASSERT_TRUE(b);
  EXPECT_EQ(b->id, 293u);
  EXPECT_EQ(b->stamp_ns, 1'500'000'000);
  EXPECT_EQ(first.summary().other_names, "can1");
}

TEST_F(AscLog, InterfacesOtherThanTheOneAskedForAreNamed) {
  CanLogReader reader(write("c.log",
                            "(1718021600.0) can1 001#00\n(1718021600.1) vcan0 001#00\n"
                            "(1718021600.2) can1 001#00\n"),
                      "can0");
  const auto opened = reader.open();
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(reader.explain(opened.error()),
              HasSubstr("3 frames are of other interfaces than can0: can1, vcan0; say which"));
}

// Types what the message says and reads what it made.
void expect_conversion(const std::string& folder, const std::string& refusal) {
  const std::size_t from = refusal.find("convert it with: ");
  ASSERT_NE(from, std::string::npos) << refusal;
  std::string command = refusal.substr(from + 17);
  command = command.substr(0, command.find("NEW.log") + 7);
  ASSERT_EQ(std::system(("cd '" + folder + "' && " + command).c_str()), 0) << command;
  CanLogReader reader(folder + "/NEW.log");
  ASSERT_TRUE(reader.open().ok()) << command;
  const auto a = reader.next();
  const auto b = reader.next();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->id, 0x311u);
  EXPECT_FALSE(a->extended);
  EXPECT_EQ(a->len, 3);
  EXPECT_EQ(a->data[2], 0xDB);
  EXPECT_EQ(b->id, 0x18FEF1FEu);
  EXPECT_TRUE(b->extended);
  EXPECT_EQ(b->stamp_ns - a->stamp_ns, 500'000'000);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.summary().broken_lines, 0u);
}

TEST_F(AscLog, OtherFormatsAreRefusedWithACommandThatConvertsThem) {
  expect_conversion(folder_.path().string(),
                    refusal(write("it's.log",
                                  "***BUSMASTER Ver 3.2.2***\n***PROTOCOL CAN***\n***HEX***\n"
                                  "15:09:15:8800 Rx 1 0x311 s 3 00 40 DB \n"
                                  "15:09:16:3800 Tx 1 0x18FEF1FE x 1 07 \n"
                                  "***[STOP LOGGING SESSION]***\n")));
  expect_conversion(folder_.path().string(),
                    refusal(write("a.csv",
                                  "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
                                  "1500000,00000311,false,Rx,0,3,00,40,DB,\n"
                                  "2000000,18FEF1FE,true,Rx,0,1,07,\n")));
  expect_conversion(folder_.path().string(),
                    refusal(write("b.csv",
                                  "Time Stamp,ID,Extended,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
                                  "1500000,311,false,0,3,00,40,DB,\n"
                                  "2000000,18FEF1FE,true,0,1,07,\n")));
  const std::string trace = write("c.trc",
                                  ";$FILEVERSION=1.1\n;$STARTTIME=43845.6\n;\n"
                                  "     1)      1500.0  Rx         0311  3  00 40 DB\n"
                                  "     2)      2000.0  Rx     18FEF1FE  1  07\n");
  EXPECT_THAT(refusal(trace),
              HasSubstr("a PCAN trace; convert it with: python3 -m can.logconvert '"));
  if (std::system("python3 -c 'import can.logconvert' 2>/dev/null") != 0) return;
  expect_conversion(folder_.path().string(), refusal(trace));
}

TEST_F(AscLog, ACompressedLogIsCalledSo) {
  EXPECT_THAT(refusal(write("a.gz", "\x1F\x8B\x08 not text")), HasSubstr("compressed by gzip"));
}

}  // namespace
}  // namespace zonepack
