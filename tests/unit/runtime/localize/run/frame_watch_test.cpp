// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/frame_watch.hpp"

#include <gmock/gmock.h>

namespace zonepack::localize {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kWatchSecond_ns = 1'000'000'000;

class FrameWatchTest : public testing::Test {
 protected:
  static GreyImage image(std::int64_t stamp_ns, std::uint8_t value, int width = 4) {
    GreyImage made;
    made.width = width;
    made.height = 2;
    made.stamp_ns = stamp_ns;
    made.pixels.assign(static_cast<std::size_t>(width) * 2, value);
    return made;
  }
  FrameWatch watch_{4, 2};
};

TEST_F(FrameWatchTest, PassesImagesThatAreNew) {
  EXPECT_EQ(watch_.refuse(image(1, 1), 1), "");
  EXPECT_EQ(watch_.refuse(image(2, 2), 2), "");
  EXPECT_EQ(watch_.refuse(image(3, 1), 3), "");
}

TEST_F(FrameWatchTest, RefusesAnotherSizeThanTheCalibrations) {
  EXPECT_EQ(watch_.refuse(image(1, 1, 8), 1), "an image of 8x2; the calibration is of 4x2");
  GreyImage short_one = image(1, 1);
  short_one.pixels.pop_back();
  EXPECT_THAT(watch_.refuse(short_one, 1), HasSubstr("the calibration is of"));
}

TEST_F(FrameWatchTest, RefusesAnImageThatIsRepeatedUntilAnotherComes) {
  EXPECT_EQ(watch_.refuse(image(1, 1), 1), "");
  EXPECT_THAT(watch_.refuse(image(2, 1), 2), HasSubstr("bit for bit"));
  EXPECT_THAT(watch_.refuse(image(3, 1), 3), HasSubstr("bit for bit"));
  EXPECT_EQ(watch_.refuse(image(4, 2), 4), "");
}

TEST_F(FrameWatchTest, RefusesAStampThatDoesNotRise) {
  EXPECT_EQ(watch_.refuse(image(5, 1), 5), "");
  EXPECT_THAT(watch_.refuse(image(5, 2), 5), HasSubstr("does not rise"));
  EXPECT_THAT(watch_.refuse(image(4, 2), 5), HasSubstr("does not rise"));
  EXPECT_EQ(watch_.refuse(image(6, 2), 6), "");
}

// 5 s old passes, a nanosecond more does not; 0.2 s ahead likewise.
TEST_F(FrameWatchTest, RefusesAStampOfAnotherTime) {
  const std::int64_t now_ns = 100 * kWatchSecond_ns;
  EXPECT_EQ(watch_.refuse(image(95 * kWatchSecond_ns, 1), now_ns), "");
  EXPECT_THAT(watch_.refuse(image(95 * kWatchSecond_ns - 1, 2), now_ns),
              HasSubstr("5.000 s behind"));
  EXPECT_EQ(watch_.refuse(image(now_ns + kWatchSecond_ns / 5, 2), now_ns), "");
  EXPECT_THAT(watch_.refuse(image(now_ns + kWatchSecond_ns / 5 + 1, 3), now_ns),
              HasSubstr("ahead"));
  EXPECT_THAT(watch_.refuse(image(INT64_MIN, 3), now_ns), HasSubstr("behind"));
  EXPECT_THAT(watch_.refuse(image(INT64_MAX, 3), -5), HasSubstr("ahead"));
}

}  // namespace
}  // namespace zonepack::localize
