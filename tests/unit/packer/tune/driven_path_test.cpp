// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/driven_path.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace zonepack::packer::tune {
namespace {

std::string refusal(const std::string& text) {
  try {
    parse_driven_path(text, "drive.txt");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(DrivenPath, IsAPathWhereTheFifthToEighthNumbersAreARotation) {
  const DrivenPath drive = parse_driven_path(
      "# stamp x y z qx qy qz qw v w\nt x y z qx qy qz qw\n"
      "1718179200.0 -8 -27 0.5 0 0 -0.6 0.8 0.1 0\n1718179200500000000,-7,-27,0.5,0,0,0,1\n",
      "drive.txt");
  EXPECT_FALSE(drive.fixes);
  ASSERT_EQ(drive.poses.size(), 2u);
  EXPECT_EQ(drive.poses[0].p_map, (Point2{-8, -27}));
  EXPECT_EQ(drive.poses[0].z_map_m, 0.5);
  EXPECT_NEAR(drive.poses[1].t_s, 1718179200.5, 1e-6);  // nanoseconds
}

TEST(DrivenPath, IsFixesWhereTheSecondNumberIsWhenTheyWereReceived) {
  const DrivenPath drive = parse_driven_path(
      "100 100.13 1.0 2.0 -0.9 0.03 0.03 0.009\n101 101.14 1.5 2.0 -0.9 0.03 0.03 0.009\n",
      "fixes.txt");
  EXPECT_TRUE(drive.fixes);
  EXPECT_EQ(drive.poses[1].p_map, (Point2{1.5, 2.0}));
}

TEST(DrivenPath, LeavesOutAFixThatIsMetresOffBothNeighbours) {
  // From (1, 2) to (5, 2) in a second are 4 m, a robot makes 0.6 + 1.5 at most.
  const DrivenPath drive = parse_driven_path(
      "100 100.1 1 2 0\n101 101.1 5 2 0\n102 102.1 1.2 2 0\n103 103.1 1.3 2 0\n", "fixes.txt");
  ASSERT_EQ(drive.poses.size(), 3u);
  EXPECT_EQ(drive.left_out, 1u);
  EXPECT_EQ(drive.poses[1].p_map, (Point2{1.2, 2}));
}

TEST(DrivenPath, NamesTheLineOfWhatIsNeither) {
  EXPECT_NE(refusal("1 2 3\n").find("drive.txt, line 1: is neither a path nor fixes"),
            std::string::npos);
  EXPECT_NE(refusal("(1718179200.0) can0 311#00\n").find("of a CAN log"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 2\n").find("line 2: expected a pose like"),
            std::string::npos);
  EXPECT_NE(refusal("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n").find("line 2: expected stamps that"),
            std::string::npos);
  EXPECT_NE(refusal("1 nan 0 0 0 0 0 1\n2 0 0 0 0 nan 0 1\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0 0 0 0 1\n\xFF\xFE\n").find("line 2: is no text"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n").find("holds no pose"), std::string::npos);
}

}  // namespace
}  // namespace zonepack::packer::tune
