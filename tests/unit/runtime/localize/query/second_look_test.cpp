// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/second_look.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/image_changes.hpp"
#include "tests/unit/runtime/localize/query/made_view.hpp"

namespace zonepack::localize {
namespace {

class SecondLookTest : public testing::Test, protected MadeView {
 protected:
  SecondLook look(const GreyImage& image, const Pose2& pose,
                  const std::vector<Sighting>& matched = {}) {
    const Candidate candidates[] = {{&map_, 0}};
    PlaceDescriber describer(detector_, image);
    return take_second_look(describer, candidates, camera_, lift(pose, 0), matched);
  }
};

TEST_F(SecondLookTest, RecognisesTheMapWhereItIs) {
  const SecondLook there = look(view_, kPlace);
  EXPECT_GT(there.points, 50);
  EXPECT_GT(there.recognised, 50);
}

TEST_F(SecondLookTest, RecognisesItInABlurredImage) {
  EXPECT_GT(look(*test_support::changed(view_, "blur:3"), kPlace).recognised, 30);
  EXPECT_GT(look(*test_support::changed(view_, "motion:9"), kPlace).recognised, 20);
}

TEST_F(SecondLookTest, RecognisesNextToNothingFromAPlaceBeside) {
  for (const Pose2& beside : {Pose2{3.3, -2, 0.7}, Pose2{3, -1.7, 0.7}, Pose2{3, -2, 0.8}}) {
    const SecondLook there = look(view_, beside);
    EXPECT_GT(there.points, 30);
    EXPECT_LT(there.recognised, 0.3 * there.points);
  }
}

TEST_F(SecondLookTest, LooksNowhereTwice) {
  std::vector<Sighting> matched;
  for (const Eigen::Vector2f& px : features_.px) {
    matched.push_back({Eigen::Vector3d::Zero(), px.cast<double>()});
  }
  EXPECT_EQ(look(view_, kPlace, matched).points, 0);
}

TEST_F(SecondLookTest, CountsNoPlaceThatShowsNothing) {
  EXPECT_EQ(look(test_support::filled(view_, 255), kPlace).points, 0);
  EXPECT_EQ(look(test_support::filled(view_, 0), kPlace).points, 0);
  const GreyImage covered = *test_support::changed(view_, "cover:0.6");
  EXPECT_LT(look(covered, kPlace).points, look(view_, kPlace).points);
}

TEST_F(SecondLookTest, SeesNothingBehindTheCamera) {
  EXPECT_EQ(look(view_, {3, -2, 0.7 + 3.14}).points, 0);
}

}  // namespace
}  // namespace zonepack::localize
