// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/calibration.hpp"

#include <gmock/gmock.h>

#include <string>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

using testing::HasSubstr;

const std::string kGood = R"(%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [385, 0, 319.5, 0, 386, 239.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0.2, 0.3, 0.4, 0.5]}
local_transform: {rows: 3, cols: 4, data: [0, 0, 1, 0.2, -1, 0, 0, 0.01, 0, -1, 0, 0.5]}
)";

// The good one with one piece of text put for another.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string fault_of(const std::string& text) {
  const auto parsed = parse_calibration(text, "camera.yaml");
  return parsed.ok() ? "" : parsed.error().message;
}

TEST(Calibration, ReadsWhatCalibrationToolsWrite) {
  const auto camera = parse_calibration(kGood, "camera.yaml");
  ASSERT_TRUE(camera.ok()) << camera.error().message;
  EXPECT_EQ(camera->width, 640);
  EXPECT_EQ(camera->height, 480);
  EXPECT_EQ(camera->fx, 385);
  EXPECT_EQ(camera->fy, 386);
  EXPECT_EQ(camera->cx, 319.5);
  EXPECT_EQ(camera->cy, 239.5);
  EXPECT_EQ(camera->distortion, (std::array<double, 5>{0.1, 0.2, 0.3, 0.4, 0.5}));
  // One metre ahead of the camera is (0.2 + 1, 0.01, 0.5) on the robot.
  const Eigen::Vector3d ahead = camera->T_base_camera * Eigen::Vector3d(0, 0, 1);
  EXPECT_LT((ahead - Eigen::Vector3d(1.2, 0.01, 0.5)).norm(), 1e-9);
}

TEST(Calibration, TakesPlainYamlAndFourCoefficients) {
  const auto camera = parse_calibration(
      with("%YAML:1.0\n---\n", "").replace(kGood.find("0.4, 0.5]") - 14, 9, "0.4]"), "camera.yaml");
  ASSERT_TRUE(camera.ok()) << camera.error().message;
  EXPECT_EQ(camera->distortion[4], 0);
}

TEST(Calibration, NamesTheFileAndTheKeyThatIsWrong) {
  EXPECT_THAT(fault_of(with("image_width: 640\n", "")), HasSubstr("camera.yaml: has no image_wid"));
  EXPECT_THAT(fault_of(with("640", "0")), HasSubstr("image_width is 0; expected 1 to 16384"));
  EXPECT_THAT(fault_of(with("480", "tall")), HasSubstr("image_height is not a number"));
  EXPECT_THAT(fault_of(with("[385", "[-385")), HasSubstr("focal length"));
  EXPECT_THAT(fault_of(with("319.5", "900")), HasSubstr("outside the image of 640x480"));
  EXPECT_THAT(fault_of(with("[385, 0,", "[385, 3,")), HasSubstr("camera_matrix is not"));
  EXPECT_THAT(fault_of(with("239.5, 0, 0, 1]", "239.5]")), HasSubstr("6 numbers; expected 9"));
  EXPECT_THAT(fault_of(with("plumb_bob", "fisheye")), HasSubstr("'fisheye'; zoneloc knows plumb"));
  EXPECT_THAT(fault_of(with("0.1, 0.2, 0.3,", "")), HasSubstr("2 numbers; expected 0, 4 or 5"));
  EXPECT_THAT(fault_of(with("0.5]}\nlocal", ".nan]}\nlocal")), HasSubstr("data[4] is not a fin"));
  EXPECT_THAT(fault_of(with("[0, 0, 1, 0.2", "[0, 0, 2, 0.2")), HasSubstr("not a rotation"));
  // A mirror is no rotation.
  EXPECT_THAT(fault_of(with("-1, 0, 0, 0.01", "1, 0, 0, 0.01")), HasSubstr("not a rotation"));
}

TEST(Calibration, RefusesWhatIsNoCalibration) {
  EXPECT_THAT(fault_of("%YAML:1.0"), HasSubstr("nothing but its first line"));
  EXPECT_THAT(fault_of("- 1\n- 2\n"), HasSubstr("is no YAML map"));
  EXPECT_THAT(fault_of("a: [1, 2"), HasSubstr("is not YAML"));
  const test_support::TemporaryFolder folder;
  const std::string file = (folder / "none.yaml").string();
  EXPECT_THAT(read_calibration(file).error().message, HasSubstr(file + ": cannot be read"));
}

}  // namespace
}  // namespace zonepack::localize
