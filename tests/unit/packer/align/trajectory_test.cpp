// SPDX-License-Identifier: Apache-2.0
#include "packer/align/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

class TrajectoryTest : public ::testing::Test {
 protected:
  Trajectory read(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    return Trajectory::read(file_);
  }
  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "t.txt";
};

TEST_F(TrajectoryTest, TakesCommentsTitlesCommasAndAByteOrderMark) {
  const Trajectory t =
      read("\xEF\xBB\xBF# TUM\r\nstamp,x,y,z,qx,qy,qz,qw\r\n1,1,2,3,0,0,0,1\r\n2\t5 2 3 0 0 0 2\n");
  ASSERT_EQ(t.poses().size(), 2u);
  EXPECT_EQ(t.poses()[1].T_frame_base.translation().x(), 5);
  EXPECT_TRUE(t.poses()[1].T_frame_base.linear().isIdentity());
}

// At a quarter of the second between 1 and 5 m: 2 m.
TEST_F(TrajectoryTest, IsLinearBetweenItsPoses) {
  const Trajectory t = read("1 1 2 3 0 0 0 1\n2 5 2 3 0 0 0 1\n");
  ASSERT_TRUE(t.at(1.25));
  EXPECT_DOUBLE_EQ(t.at(1.25)->translation().x(), 2);
  EXPECT_TRUE(t.at(2));
  EXPECT_FALSE(t.at(0.9));
  EXPECT_FALSE(t.at(2.1));
}

TEST_F(TrajectoryTest, SaysNothingInAGapOfMoreThanASecond) {
  EXPECT_FALSE(read("1 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n").at(2));
}

TEST_F(TrajectoryTest, NamesTheLineThatIsWrong) {
  EXPECT_THAT(error_of("1 1 2 3 0 0 0 1\n2 5 2 3 0 0 0\n"),
              HasSubstr("line 2: expected 8 numbers"));
  EXPECT_THAT(error_of("1 1 2 nan 0 0 0 1\n"), HasSubstr("line 1: expected 8 numbers"));
  EXPECT_THAT(error_of("1 1 2 3 0 0 0 0\n"), HasSubstr("of no length"));
  EXPECT_THAT(error_of("2 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n"),
              HasSubstr("line 2: expected stamps that ascend"));
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("holds no pose"));
  EXPECT_THAT(error_of("SQLite format 3\0 and so on"), HasSubstr("no pose"));
}

TEST_F(TrajectoryTest, AMissingFileIsNamed) {
  EXPECT_THROW(Trajectory::read(folder_ / "none.txt"), std::runtime_error);
}

}  // namespace
}  // namespace zonepack::packer
