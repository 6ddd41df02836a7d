// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/sight_watch.hpp"

#include <gtest/gtest.h>

namespace zonepack::localize {
namespace {

QueryResult image_of(Reason reason, int distinct = 0, int visible = 0) {
  QueryResult result;
  result.accepted = reason == Reason::kAccepted;
  result.reason = reason;
  result.distinct = distinct;
  result.visible = visible;
  result.signatures = 3;
  return result;
}

int images_until_lost(const QueryResult& result, bool trusted, bool own_zone) {
  SightWatch watch;
  for (int i = 1; i <= 100; ++i) {
    if (watch.add(result, trusted, own_zone)) return i;
  }
  return 0;
}

// 7 of 100 are fewer than 12.
TEST(SightWatch, GivesAPoseUpThatImagesContradict) {
  const QueryResult against = image_of(Reason::kFewInliers, 7, 100);
  EXPECT_EQ(images_until_lost(against, true, true), 12);
  EXPECT_EQ(images_until_lost(against, false, true), 5);
}

// 14 of 100 are not; such images only show nothing.
TEST(SightWatch, HasMorePatienceWithImagesThatShowNothing) {
  const QueryResult nothing = image_of(Reason::kFewInliers, 14, 100);
  EXPECT_EQ(images_until_lost(nothing, true, true), 40);
  EXPECT_EQ(images_until_lost(nothing, false, true), 12);
}

TEST(SightWatch, BlamesNoPoseForAZoneThatIsNotThereOrADarkImage) {
  EXPECT_EQ(images_until_lost(image_of(Reason::kFewInliers), true, false), 0);
  EXPECT_EQ(images_until_lost(image_of(Reason::kNoFeatures), true, true), 0);
}

TEST(SightWatch, BeginsAgainAfterAFix) {
  SightWatch watch;
  for (int i = 0; i < 11; ++i) watch.add(image_of(Reason::kFewInliers, 7, 100), true, true);
  EXPECT_FALSE(watch.add(image_of(Reason::kAccepted, 40, 100), true, true));
  EXPECT_FALSE(watch.add(image_of(Reason::kFewInliers, 7, 100), true, true));
}

}  // namespace
}  // namespace zonepack::localize
