// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/check/calibration_text.hpp"

#include <gmock/gmock.h>

#include "runtime/localize/camera/calibration.hpp"
#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

TEST(CalibrationText, SaysWhatIsWrongWithUnitsAndDirection) {
  EXPECT_EQ(finding_text({CameraTrait::kHeight, -0.05, 0.003}, "c.yaml"),
            "the camera seems 5.0 +- 0.3 cm lower than c.yaml says");
  EXPECT_EQ(finding_text({CameraTrait::kFocal, 0.02, 0.00001}, "c.yaml"),
            "the focal length seems 2.0 +- 0.1 % longer than c.yaml says");
  // 0.0174533 rad is a degree.
  EXPECT_EQ(finding_text({CameraTrait::kPitch, 0.0174533, 0.00174533}, "c.yaml"),
            "the camera seems to look 1.00 +- 0.10 degrees lower than c.yaml says");
  EXPECT_EQ(finding_text({CameraTrait::kRoll, -0.0174533, 0.00174533}, "c.yaml"),
            "the camera seems to lean 1.00 +- 0.10 degrees more to the left than c.yaml says");
}

// What is pasted reads back as the camera that was meant.
TEST(CalibrationText, GivesTheYamlThatACalibrationReads) {
  const CameraModel camera = corrected(made_camera(), {0.02, -0.05, 0, 0});
  const std::string yaml = calibration_yaml(
      camera, {{CameraTrait::kFocal, 0.02, 0.001}, {CameraTrait::kHeight, -0.05, 0.001}});
  const auto read =
      parse_calibration("image_width: 640\nimage_height: 480\n" + yaml, "camera.yaml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR(read->fx, 392.7, 1e-9);
  EXPECT_NEAR(read->T_base_camera.translation().z(), 0.45, 1e-9);
  EXPECT_EQ(calibration_yaml(camera, {{CameraTrait::kFocal, 0.02, 0.001}}).find("local_transform"),
            std::string::npos);
}

TEST(CalibrationText, WritesJsonThatIsUndecidedWithTooFewFixes) {
  CalibrationReport report;
  report.fixes = 7;
  EXPECT_EQ(report_json(report), R"({"fixes": 7, "ok": null, "findings": []})");
  report.enough = true;
  EXPECT_EQ(report_json(report), R"({"fixes": 7, "ok": true, "findings": []})");
  report.findings = {{CameraTrait::kHeight, -0.5, 0.25}};
  EXPECT_EQ(
      report_json(report),
      R"({"fixes": 7, "ok": false, "findings": [{"trait": "height", "value": -0.5, "sigma": 0.25}]})");
}

}  // namespace
}  // namespace zonepack::localize
