// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/run_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <string>

namespace zonepack {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class RunFiles : public testing::Test {
 protected:
  ~RunFiles() override { ::unlink(path_.c_str()); }
  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  std::string path_ = testing::TempDir() + "run_file_" + std::to_string(::getpid()) + ".txt";
};

TEST_F(RunFiles, ReadsCorrectionsToTheNanosecond) {
  write(
      "# stamp received x y yaw sigma_x sigma_y sigma_yaw\r\n"
      "1718021600.000000 1718021600.141691 0.8842 10.9826 -2.60115 0.030 0.031 0.00873\r\n"
      "\n"
      "  1718021601.123456789\t1718021602 -1e-1 +2 3 nan -0.03 inf\n");
  const auto read = read_corrections(path_);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].stamp_ns, 1'718'021'600'000'000'000);
  EXPECT_EQ((*read)[0].received_ns, 1'718'021'600'141'691'000);
  EXPECT_EQ((*read)[0].T_map_base, (Pose2{0.8842, 10.9826, -2.60115}));
  EXPECT_EQ((*read)[0].sigma_y_m, 0.031);
  EXPECT_EQ((*read)[1].stamp_ns, 1'718'021'601'123'456'789);
  EXPECT_EQ((*read)[1].T_map_base.x_m, -0.1);
  EXPECT_TRUE(std::isnan((*read)[1].sigma_x_m));
  EXPECT_EQ((*read)[1].sigma_y_m, -0.03);
}

// As spreadsheets, Windows and recorders of other programs write them.
TEST_F(RunFiles, TakesHeadersCommasMarksAndNanoseconds) {
  write(
      "\xEF\xBB\xBFstamp,received,x,y,yaw,sigma_x,sigma_y,sigma_yaw\r\n"
      "% a remark\r\n"
      "1718021600000000123,1718021600.5, 1,2,\t0.5;0.1,0.1,0.1\r\n");
  const auto read = read_corrections(path_);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 1u);
  EXPECT_EQ((*read)[0].stamp_ns, 1'718'021'600'000'000'123);
  EXPECT_EQ((*read)[0].received_ns, 1'718'021'600'500'000'000);
  EXPECT_EQ((*read)[0].T_map_base.y_m, 2);

  write("\xEF\xBB\xBF#timestamp x y z\n1,3,4,0,0,0,0,1\n");
  const auto truth = read_truth(path_);
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->samples()[0].T_map_base.x_m, 3);

  // Only the first line may be names.
  write("1 3 4 0 0 0 0 1\nt x y z qx qy qz qw\n");
  EXPECT_THAT(read_truth(path_).error().message, HasSubstr(":2: \"t\" is not a stamp"));
  write("version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  EXPECT_THAT(read_truth(path_).error().message, HasSubstr("a Git LFS pointer"));
}

// EuRoC's ground truth: the first line names the columns, and qw comes first. 90 degrees to the
// left.
TEST_F(RunFiles, TakesTheOrderOfAQuaternionFromTheColumnNames) {
  const std::string line = ",1,2,0,0.70710678,0,0,0.70710678,0,0,0,0\n";
  const std::string lines = "1403636580838555648" + line + "1403636580888555648" + line;
  for (const char* const names :
       {"#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], "
        "q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\n",
        "t x y z qw qx qy qz\n", "# t x y z qw qx qy qz\n"}) {
    write(names + lines);
    const auto truth = read_truth(path_);
    ASSERT_TRUE(truth) << truth.error().message;
    EXPECT_NEAR(truth->samples()[0].T_map_base.yaw_rad, 1.5707963, 1e-6) << names;
  }
  // Without names the robot would lie on its side.
  write(lines);
  EXPECT_THAT(read_truth(path_).error().message,
              HasSubstr("seem to be qw qx qy qz, as EuRoC writes them: name the columns in a first "
                        "line: # t x y z qw qx qy qz"));
}

TEST_F(RunFiles, CorrectionsComeInOrderOfReception) {
  write("1 5 1 0 0 1 1 1\n3 4 2 0 0 1 1 1\n2 4 3 0 0 1 1 1\n");
  const auto read = read_corrections(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)[0].T_map_base.x_m, 2);
  EXPECT_EQ((*read)[1].T_map_base.x_m, 3);
  EXPECT_EQ((*read)[2].T_map_base.x_m, 1);
}

TEST_F(RunFiles, AFixMaySayHowFarItsLocalizerSees) {
  write("1 2 3 4 0.5 0.1 0.1 0.1 8.5\n2 3 3 4 0.5 0.1 0.1 0.1\n");
  const auto read = read_corrections(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ((*read)[0].view_m, 8.5);
  EXPECT_EQ((*read)[1].view_m, 0);
}

TEST_F(RunFiles, ABadLineIsNamedWithTheExpectedColumns) {
  struct Case {
    const char *text, *fault;
  };
  for (const Case& c : {
           Case{"1 2 3 4 5 6 7\n", ":1: 7 columns; expected stamp received x y yaw"},
           Case{"1 2 3 4 5 6 7 8 9 10\n", ":1: 10 columns"},
           Case{"1 2 3 4 5 6 7 8 far\n", ":1: \"far\" is not a number"},
           Case{"# x\n1 2 3 4 five 6 7 8\n", ":2: \"five\" is not a number"},
           Case{"1 2 3 4 5 6 7 8x\n", ":1: \"8x\" is not a number"},
           Case{"-1 2 3 4 5 6 7 8\n", ":1: \"-1\" is not a stamp in seconds"},
           Case{"nan 2 3 4 5 6 7 8\n", ":1: \"nan\" is not a stamp"},
           Case{"1 99999999999 3 4 5 6 7 8\n", ":1: \"99999999999\" is not a stamp"},
           Case{"1.2.3 2 3 4 5 6 7 8\n", ":1: \"1.2.3\" is not a stamp"},
           Case{"1 1e300 3 4 5 6 7 8\n", ":1: \"1e300\" is not a stamp"},
       }) {
    write(c.text);
    const auto read = read_corrections(path_);
    ASSERT_FALSE(read) << c.text;
    EXPECT_THAT(read.error().message, StartsWith(path_ + c.fault));
  }
  const auto absent = read_corrections(path_ + ".absent");
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().message, HasSubstr("No such file"));
  write("");
  EXPECT_TRUE(read_corrections(path_)->empty());  // a run without fixes
}

TEST_F(RunFiles, StampsMayHaveAnExponent) {
  write("1.718021600500000e+09 1718021601 0 0 0 1 1 1\n");
  const auto read = read_corrections(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(static_cast<double>((*read)[0].stamp_ns), 1'718'021'600.5e9, 500);
}

TEST_F(RunFiles, TruthIsInterpolatedTheShortWayRound) {
  // Headings 170 and -170 degrees: sine and cosine of the half angles.
  write(
      "# t x y z qx qy qz qw v w\n"
      "10.0 0 0 0 0 0 0.99619470 0.08715574 0.5 0.1\n"
      "10.2 1 2 0 0 0 0.99619470 -0.08715574 0.5 0.1\n");
  const auto truth = read_truth(path_);
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->at(9'999'999'999), std::nullopt);
  EXPECT_EQ(truth->at(10'200'000'001), std::nullopt);
  const Pose2 middle = *truth->at(10'100'000'000);
  EXPECT_NEAR(middle.x_m, 0.5, 1e-12);
  EXPECT_NEAR(middle.y_m, 1.0, 1e-12);
  EXPECT_NEAR(std::abs(middle.yaw_rad), 3.14159265, 1e-6);
  EXPECT_NEAR(truth->at(10'050'000'000)->yaw_rad, 175 * 3.14159265 / 180, 1e-6);
  EXPECT_NEAR(truth->at(10'200'000'000)->yaw_rad, -170 * 3.14159265 / 180, 1e-6);
}

TEST_F(RunFiles, TruthThatStepsBackOrTurnsIntoNothingIsRefused) {
  struct Case {
    const char *text, *fault;
  };
  for (const Case& c : {
           Case{"2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n",
                ":2: stamp 1 before the one on the line above; poses stand in order of time: sort "
                "-n"},
           Case{"1 0 0 0 0 0 0 0\n", ":1: a quaternion that is not of length 1; expected t x y z"},
           Case{"1 0 0 0 0 0 nan 1\n", ":1: a quaternion"},
           Case{"1 inf 0 0 0 0 0 1\n", ":1: a position that is not finite"},
           Case{"1 0 0 0 0 0 1\n", ":1: 7 columns; expected t x y z qx qy qz qw"},
           Case{"# nothing\n", ": no samples"},
       }) {
    write(c.text);
    const auto read = read_truth(path_);
    ASSERT_FALSE(read) << c.text;
    EXPECT_THAT(read.error().message, StartsWith(path_ + c.fault));
  }
}

}  // namespace
}  // namespace zonepack
