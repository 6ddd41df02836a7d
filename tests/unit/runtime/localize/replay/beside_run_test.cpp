// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/beside_run.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

class BesideRunTest : public testing::Test {
 protected:
  Outcome<BesideRun> read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_beside(path_);
  }
  std::string problem_of(const std::string& text) {
    const auto run = read(text);
    return run ? "" : run.error().message;
  }

  test_support::TemporaryFolder folder_;
  std::string path_ = (folder_ / "other.txt").string();
};

TEST_F(BesideRunTest, TakesTheAcceptedRowsOfARecordedRun) {
  const auto run = read(
      "# init_ms=5\n"
      "frame,t,accepted,gx,mx,my,myaw\r\n"
      "0,1000.5,0,9,1,2,3\r\n"
      "1,1001.25,371,9,4.5,-5,0.5\r\n");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->name, "RTAB-Map");
  EXPECT_EQ(run->images, 2U);
  ASSERT_EQ(run->fixes.size(), 1U);
  EXPECT_EQ(run->fixes[0].stamp_ns, 1'001'250'000'000);
  EXPECT_EQ(run->fixes[0].T_map_base, (Pose2{4.5, -5, 0.5}));
}

TEST_F(BesideRunTest, TakesEachPoseOfAListAsAFix) {
  // A quarter turn to the left: qz = qw = sqrt(1/2).
  const auto run = read("1000.5 1 2 0 0 0 0.70710678 0.70710678\n1001 3 4 0 0 0 0 1\n");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->name, "other.txt");
  EXPECT_EQ(run->images, 0U);
  ASSERT_EQ(run->fixes.size(), 2U);
  EXPECT_EQ(run->fixes[0].stamp_ns, 1'000'500'000'000);
  EXPECT_NEAR(run->fixes[0].T_map_base.yaw_rad, 1.5707963, 1e-6);
}

TEST_F(BesideRunTest, NamesWhatIsWrong) {
  EXPECT_NE(problem_of("t,accepted,mx,my\n1,1,0,0\n").find(":1: no column 'myaw'"),
            std::string::npos);
  EXPECT_NE(problem_of("t,accepted,mx,my,myaw\n1,1,zero,0,0\n").find(":2: column mx: 'zero'"),
            std::string::npos);
  EXPECT_NE(problem_of("t,accepted,mx,my,myaw\n1e12,1,0,0,0\n").find(":2: column t"),
            std::string::npos);
  EXPECT_NE(problem_of("t,accepted,mx,my,myaw\n").find("has no rows"), std::string::npos);
  // Neither of the two: both are named.
  const std::string neither = problem_of("hello\nworld\n");
  EXPECT_NE(neither.find("qx qy qz qw"), std::string::npos) << neither;
  EXPECT_NE(neither.find("t, accepted, mx, my, myaw"), std::string::npos) << neither;
  const auto none = read_beside((folder_ / "none").string());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("No such file"), std::string::npos);
}

}  // namespace
}  // namespace zonepack::localize
