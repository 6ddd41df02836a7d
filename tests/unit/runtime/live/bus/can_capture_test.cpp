// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_capture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <vector>

#include "platform/can/can_log.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kOffset = 1'700'000'000'000'000'000;

CanFrame frame(std::uint32_t id, std::int64_t stamp_ns, std::vector<std::uint8_t> data) {
  CanFrame made;
  made.id = id;
  made.stamp_ns = stamp_ns;
  made.len = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), made.data.begin());
  return made;
}

class CanCaptureTest : public testing::Test {
 protected:
  std::string written() {
    EXPECT_TRUE(recorder_.close());
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }
  std::size_t receive() {
    std::array<CanFrame, 64> into;
    bus_.advance_to(INT64_MAX);
    return recorder_.receive(into);
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_.path() / "can.log").string();
  SimCanBus bus_;
  CanCapture recorder_{bus_, "can0", kOffset};
};

TEST_F(CanCaptureTest, WritesWhatCandumpWrites) {
  ASSERT_TRUE(recorder_.open(path_));
  bus_.push(frame(0x311, 1'234'567'890, {0, 0x40, 0xDB}));
  CanFrame extended = frame(0x18FF1234, 1'234'999'999, {});
  extended.extended = true;
  bus_.push(extended);
  CanFrame fd = frame(0x7, 2'000'000'000, {1, 2});
  fd.fd = true;
  fd.flags = 1;
  bus_.push(fd);
  CanFrame remote = frame(0x221, 2'000'000'000, {});
  remote.rtr = true;
  remote.len = 8;
  bus_.push(remote);
  CanFrame error = frame(0x40, 3'000'000'000, {0, 0, 0, 0, 0, 0, 0, 0});
  error.error = true;
  bus_.push(error);
  EXPECT_EQ(receive(), 5u);
  EXPECT_EQ(written(),
            "(1700000001.234567) can0 311#0040DB\n"
            "(1700000001.234999) can0 18FF1234#\n"
            "(1700000002.000000) can0 007##10102\n"
            "(1700000002.000000) can0 221#R8\n"
            "(1700000003.000000) can0 20000040#0000000000000000\n");
}

TEST_F(CanCaptureTest, TellsOfFramesThatWereLostBeforeOne) {
  ASSERT_TRUE(recorder_.open(path_));
  bus_.push(frame(1, 0, {}));
  receive();
  bus_.lose(2);
  for (int i = 0; i < 3; ++i) bus_.push(frame(2, 1'000'000, {}));
  receive();
  EXPECT_EQ(written(),
            "(1700000000.000000) can0 001#\n"
            "DROPCOUNT: dropped 2 CAN frames on 'can0' socket (total drops 2)\n"
            "(1700000000.001000) can0 002#\n");
}

TEST_F(CanCaptureTest, LosesFramesAndNotTimeWhenTheWriterDoesNotKeepUp) {
  ASSERT_TRUE(recorder_.open(path_));
  std::size_t received = 0;
  for (int i = 0; i < 5000; ++i) {
    bus_.push(frame(1, i, {}));
    received += receive();
  }
  EXPECT_EQ(received, 5000u);
  recorder_.write();  // 4096 of them
  bus_.push(frame(2, 6000, {}));
  receive();
  EXPECT_NE(written().find("DROPCOUNT: dropped 904 "), std::string::npos);
}

TEST_F(CanCaptureTest, GivesBackWhatItRecordedToTheReaderOfLogs) {
  ASSERT_TRUE(recorder_.open(path_));
  std::vector<CanFrame> sent;
  for (std::uint8_t i = 0; i < 40; ++i) {
    sent.push_back(frame(0x100u + i, i * 1'000'000, std::vector<std::uint8_t>(i % 9, i)));
    bus_.push(sent.back());
  }
  receive();
  ASSERT_TRUE(recorder_.close());
  CanLogReader reader(path_, "can0");
  ASSERT_TRUE(reader.open());
  for (const CanFrame& frame : sent) {
    const auto read = reader.next();
    ASSERT_TRUE(read);
    EXPECT_EQ(read->stamp_ns, frame.stamp_ns + kOffset);
    EXPECT_EQ(read->id, frame.id);
    EXPECT_EQ(read->data, frame.data);
  }
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.summary().broken_lines, 0u);
}

TEST_F(CanCaptureTest, SaysWhenItCannotWrite) {
  EXPECT_EQ(recorder_.open("/nowhere/can.log").error().code, ErrorCode::kIo);
  ASSERT_TRUE(recorder_.open("/dev/full"));
  bus_.push(frame(1, 0, {}));
  receive();
  EXPECT_EQ(recorder_.close().error(), (Error{ErrorCode::kIo, ENOSPC}));
}

}  // namespace
}  // namespace zonepack
