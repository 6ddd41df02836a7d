// SPDX-License-Identifier: Apache-2.0
// What every camera of a kernel must hold, on the first /dev/video* that gives 640x480: images with
// the driver's own rising stamps, whole ones, again after it was closed; another size is refused by
// name. On the kernel's virtual camera: modprobe vivid.
#include <gmock/gmock.h>

#include <filesystem>
#include <iostream>

#include "platform/devices/video_device.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kPatience_ns = 10'000'000'000;

std::string camera() {
  for (int i = 0; i < 16; ++i) {
    const std::string path = "/dev/video" + std::to_string(i);
    if (std::filesystem::exists(path) && VideoDevice::open({path, 640, 480})) return path;
  }
  return {};
}

class VideoDeviceContract : public testing::Test {
 protected:
  void SetUp() override {
    path_ = camera();
    if (path_.empty()) {
      std::cout << "NOT TESTED: no camera gives 640x480 here; modprobe vivid makes one\n";
      GTEST_SKIP() << "no camera gives 640x480 here";
    }
  }
  std::string path_;
};

TEST_F(VideoDeviceContract, GivesWholeImagesWithRisingStamps) {
  for (int round = 0; round < 2; ++round) {
    auto device = VideoDevice::open({path_, 640, 480});
    ASSERT_TRUE(device) << device.error().message;
    std::int64_t last_ns = 0;
    for (int i = 0; i < 10; ++i) {
      const auto frame = (*device)->next(monotonic_ns() + kPatience_ns);
      ASSERT_TRUE(frame) << to_string(frame.error().code);
      EXPECT_TRUE(frame->stamped_by_driver);
      EXPECT_GT(frame->stamp_ns, last_ns);
      EXPECT_LT(std::abs(frame->stamp_ns - monotonic_ns()), 1'000'000'000);
      if (frame->format != VideoFormat::kMjpeg) {
        EXPECT_GE(frame->bytes.size(), std::size_t{frame->row_bytes} * 480);
      }
      last_ns = frame->stamp_ns;
    }
  }
}

TEST_F(VideoDeviceContract, IsRefusedASizeThatItDoesNotHave) {
  const auto device = VideoDevice::open({path_, 641, 481});
  ASSERT_FALSE(device);
  EXPECT_THAT(device.error().message, testing::HasSubstr("does not give 641x481"));
}

}  // namespace
}  // namespace zonepack
