// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/camera_model.hpp"

#include <gtest/gtest.h>

#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

TEST(CameraModel, BendsAPixelAsTheLensDoes) {
  CameraModel camera = made_camera();
  camera.distortion = {0.1, 0, 0, 0, 0};
  // 192.5 px to the right is 0.5 of the focal length: r^2 = 0.25, factor 1 + 0.1 * 0.25 = 1.025,
  // 385 * 0.5 * 1.025 = 197.3125.
  const Eigen::Vector2d seen = camera.distort({319.5 + 192.5, 239.5});
  EXPECT_NEAR(seen.x(), 319.5 + 197.3125, 1e-9);
  EXPECT_NEAR(seen.y(), 239.5, 1e-9);
}

TEST(CameraModel, ShiftsAPixelAlongATiltedLens) {
  CameraModel camera = made_camera();
  camera.distortion = {0, 0, 0.01, 0, 0};
  // x = y = 0.5, r^2 = 0.5: dx = 2 p1 x y = 0.005, dy = p1 (r^2 + 2 y^2) = 0.01; times 385: 1.925
  // and 3.85 px.
  const Eigen::Vector2d seen = camera.distort({319.5 + 192.5, 239.5 + 192.5});
  EXPECT_NEAR(seen.x(), 319.5 + 192.5 + 1.925, 1e-9);
  EXPECT_NEAR(seen.y(), 239.5 + 192.5 + 3.85, 1e-9);
}

TEST(CameraModel, UndoesWhatTheLensDoesOverTheWholeImage) {
  CameraModel camera = made_camera();
  camera.distortion = {-0.12, 0.03, 0.001, -0.0007, -0.002};
  EXPECT_TRUE(camera.distorted());
  for (double x = 10; x < 640; x += 103) {
    for (double y = 10; y < 480; y += 91) {
      const Eigen::Vector2d back = camera.distort(camera.undistort({x, y}));
      EXPECT_NEAR(back.x(), x, 0.01);
      EXPECT_NEAR(back.y(), y, 0.01);
    }
  }
}

TEST(CameraModel, LeavesPixelsOfAnIdealLensAlone) {
  const CameraModel camera = made_camera();
  EXPECT_FALSE(camera.distorted());
  EXPECT_EQ(camera.undistort({12, 34}), Eigen::Vector2d(12, 34));
}

}  // namespace
}  // namespace zonepack::localize
