// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/event_log.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "runtime/pack_format/file/checksum.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

std::string_view name_of(ZoneId zone) { return zone == 0 ? "ward \"A\"" : "B"; }

Event load_done() {
  Event event;
  event.kind = EventKind::kLoadDone;
  event.cycle = 7;
  event.t_ns = 70'000'000;
  event.zone = 0;
  event.generation = 2;
  event.signatures = 31;
  event.bytes = 32960;
  event.charged_signatures = 47;
  event.charged_bytes = 100000;
  return event;
}

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class EventLogTest : public testing::Test {
 protected:
  const test_support::TemporaryFolder folder;
  const std::string path = folder / "events.jsonl";
};

TEST_F(EventLogTest, WritesOneJsonObjectALineWithItsFieldsInOrder) {
  EventLog log(name_of);
  ASSERT_TRUE(log.write_to(path).ok());
  log.on_event(load_done());
  Event rejected;
  rejected.kind = EventKind::kCorrectionRejected;
  rejected.reason = "outlier";
  rejected.has_pose = true;
  rejected.x_mm = -5;
  log.on_event(rejected);
  ASSERT_TRUE(log.close().ok());
  EXPECT_EQ(read(path),
            "{\"cycle\":7,\"t_ns\":70000000,\"event\":\"load_done\",\"zone\":\"ward \\\"A\\\"\","
            "\"signatures\":31,\"bytes\":32960,\"generation\":2,\"charged_signatures\":47,"
            "\"charged_bytes\":100000}\n"
            "{\"cycle\":0,\"t_ns\":0,\"event\":\"correction_rejected\",\"charged_signatures\":0,"
            "\"charged_bytes\":0,\"reason\":\"outlier\",\"x_mm\":-5,\"y_mm\":0,\"yaw_mrad\":0}\n");
}

TEST_F(EventLogTest, HashesExactlyTheBytesOfTheFile) {
  EventLog log(name_of);
  ASSERT_TRUE(log.write_to(path).ok());
  for (int i = 0; i < 3000; ++i) log.on_event(load_done());  // more than one buffer
  ASSERT_TRUE(log.close().ok());
  const std::string bytes = read(path);
  EXPECT_EQ(log.hash(), to_hex(blake2b_32({std::as_bytes(std::span(bytes))})));
}

TEST_F(EventLogTest, HashesTheSameWithoutAFile) {
  EventLog with(name_of), without(name_of);
  ASSERT_TRUE(with.write_to(path).ok());
  with.on_event(load_done());
  without.on_event(load_done());
  EXPECT_EQ(with.hash(), without.hash());
}

TEST_F(EventLogTest, OfNothingHashesTheEmptyText) {
  // BLAKE2b-256 of no bytes, from the reference implementation.
  EXPECT_EQ(EventLog(name_of).hash(),
            "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8");
}

TEST_F(EventLogTest, SaysWhenItsFileCannotBeMade) {
  EXPECT_EQ(EventLog(name_of).write_to("/nowhere/at/all.jsonl").error(),
            (Error{ErrorCode::kIo, ENOENT}));
}

}  // namespace
}  // namespace zonepack
