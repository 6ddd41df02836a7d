// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/command_lines.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/run/inputs/run_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

class CommandLines : public testing::Test {
 protected:
  Outcome<std::vector<TimedCommand>> read(const std::string& text) {
    std::ofstream(folder / "fixes.txt") << text;
    return read_command_lines(folder / "fixes.txt", [](std::string_view name) {
      return name == "Hall 2" ? ZoneId{7} : kNoZone;
    });
  }
  const test_support::TemporaryFolder folder;
};

TEST_F(CommandLines, AreReadAsTheyWereWritten) {
  Command lost, seek, none, turn;
  lost.kind = Command::Kind::kLost;
  seek.kind = none.kind = Command::Kind::kSeek;
  seek.zone = 7;
  turn.kind = Command::Kind::kAskTurn;
  const auto read_back =
      read(command_line(3'000'000'001, turn, "") + command_line(1'500'000'000, lost, "") +
           command_line(2'000'000'000, seek, "Hall 2") + command_line(2'500'000'000, none, "") +
           "1.5 1.6 1 2 3 0.1 0.1 0.1\n# a remark\n");
  ASSERT_TRUE(read_back) << read_back.error().message;
  ASSERT_EQ(read_back->size(), 4u);
  EXPECT_EQ((*read_back)[0].received_ns, 1'500'000'000);
  EXPECT_EQ((*read_back)[0].command.kind, Command::Kind::kLost);
  EXPECT_EQ((*read_back)[1].command.kind, Command::Kind::kSeek);
  EXPECT_EQ((*read_back)[1].command.zone, 7u);
  EXPECT_EQ((*read_back)[2].command.zone, kNoZone);
  EXPECT_EQ((*read_back)[3].received_ns, 3'000'000'001);
  EXPECT_EQ((*read_back)[3].command.kind, Command::Kind::kAskTurn);
  // Whoever reads fixes alone passes over them.
  const auto fixes = read_corrections(folder / "fixes.txt");
  ASSERT_TRUE(fixes) << fixes.error().message;
  EXPECT_EQ(fixes->size(), 1u);
}

TEST_F(CommandLines, HoldTheZonesOfARoute) {
  const auto hints =
      read("# command 1 route_hint Hall 2/Hall 2 / Hall 2\r\n# command 2 route_hint\n");
  ASSERT_TRUE(hints) << hints.error().message;
  ASSERT_EQ(hints->size(), 2u);
  EXPECT_EQ((*hints)[0].command.kind, Command::Kind::kRouteHint);
  EXPECT_EQ((*hints)[0].command.route_length, 3u);
  EXPECT_EQ((*hints)[0].command.route[2], 7u);
  EXPECT_EQ((*hints)[1].command.route_length, 0u);
}

TEST_F(CommandLines, NameTheLineThatIsWrong) {
  const auto message = [&](const std::string& text) {
    const auto read_back = read("# fixes\n" + text + "\n");
    return read_back ? std::string("read") : read_back.error().message;
  };
  EXPECT_NE(message("# command soon lost").find("fixes.txt:2: \"soon\" is not a stamp"),
            std::string::npos);
  EXPECT_NE(message("# command 1 stop").find("\"stop\" is not a command"), std::string::npos);
  EXPECT_NE(message("# command 1 seek Attic").find("the map has no zone Attic"), std::string::npos);
  EXPECT_NE(message("# command 1 route_hint Hall 2/Attic").find("the map has no zone Attic"),
            std::string::npos);
  EXPECT_NE(message("# command 1 route_hint Hall 2/").find("the map has no zone "),
            std::string::npos);
  EXPECT_NE(message("# command 1 lost Hall 2").find("lost takes no zone"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
