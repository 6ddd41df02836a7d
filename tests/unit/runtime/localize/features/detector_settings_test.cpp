// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/detector_settings.hpp"

#include <gmock/gmock.h>

namespace zonepack::localize {
namespace {

using testing::HasSubstr;

TEST(DetectorSettings, AreThoseThatTheManifestNames) {
  const auto parsed = parse_detector(
      "8 Kp/MaxFeatures:300;GFTT/MinDistance:5;GFTT/MinDistance:7;ORB/NLevels:3", "m");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->detector, Detector::kGfttOrb);
  EXPECT_EQ(parsed->max_features, 300);
  EXPECT_EQ(parsed->min_distance_px, 7);  // the last one counts
  EXPECT_EQ(parsed->levels, 3);
  EXPECT_EQ(parsed->descriptor_bytes(), 32u);
}

TEST(DetectorSettings, AreTheSourcesDefaultsWithoutSettings) {
  const auto parsed = parse_detector("8", "m");
  ASSERT_TRUE(parsed.ok());
  EXPECT_EQ(parsed->max_features, 500);
}

TEST(DetectorSettings, RefuseADetectorThatOpenCvLacksByItsName) {
  EXPECT_THAT(parse_detector("6", "maps/a").error().message,
              testing::AllOf(HasSubstr("maps/a"), HasSubstr("GFTT/BRIEF"), HasSubstr("SIFT"),
                             HasSubstr("map again with Kp/DetectorStrategy 8, 2, 1 or 7")));
  EXPECT_THAT(parse_detector("11", "m").error().message, HasSubstr("SuperPoint"));
  EXPECT_THAT(parse_detector("orb_slam", "m").error().message, HasSubstr("'orb_slam'"));
  EXPECT_THAT(parse_detector("", "m").error().message, HasSubstr("does not say"));
}

TEST(DetectorSettings, RefuseAValueThatNoDetectorTakesByItsKey) {
  EXPECT_THAT(parse_detector("8 GFTT/QualityLevel:none", "m").error().message,
              HasSubstr("GFTT/QualityLevel of its detector is 'none'"));
  EXPECT_THAT(parse_detector("8 ORB/NLevels:2.5", "m").error().message, HasSubstr("ORB/NLevels"));
}

}  // namespace
}  // namespace zonepack::localize
