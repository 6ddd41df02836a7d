// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/video_device.hpp"

#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <set>
#include <vector>

#include "platform/linux/video_calls.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Offer {
  std::uint32_t fourcc;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes;
};

// A driver as V4L2 describes it: four buffers, each the driver's or the program's.
class FakeDriver final : public VideoCalls {
 public:
  int open_error = 0;
  bool device = true;
  std::uint32_t caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<Offer> offers = {{V4L2_PIX_FMT_YUYV, {{640, 480}}}};
  std::uint32_t stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  bool unplugged = false;
  std::uint32_t buffer_bytes = 64;

  bool streaming = false;
  int opened = 0, closed = 0;
  std::set<void*> mapped;
  std::uint32_t format = 0;

  // The camera took an image, unless no buffer is free.
  void expose(std::byte value, std::int64_t stamp_us, std::uint32_t flags = 0) {
    ++sequence_;
    if (free_.empty()) return;
    v4l2_buffer buffer{};
    buffer.index = free_.front();
    free_.pop_front();
    buffer.bytesused = 16;
    buffer.flags = stamp_flags | flags;
    buffer.timestamp.tv_sec = stamp_us / 1'000'000;
    buffer.timestamp.tv_usec = stamp_us % 1'000'000;
    buffer.sequence = sequence_;
    std::memset(memory_[buffer.index], std::to_integer<int>(value), 16);
    done_.push_back(buffer);
  }

  int open(const char*) noexcept override {
    if (open_error != 0) return fail(open_error);
    ++opened;
    return 7;
  }
  bool is_device(int) noexcept override { return device; }
  void* map(int, std::size_t bytes, std::int64_t offset) noexcept override {
    EXPECT_EQ(bytes, buffer_bytes);
    void* const at = memory_[offset / 4096];
    mapped.insert(at);
    return at;
  }
  void unmap(void* at, std::size_t) noexcept override { mapped.erase(at); }
  int wait(int, int) noexcept override { return done_.empty() ? 0 : 1; }
  void close(int) noexcept override { ++closed; }

  int control(int, unsigned long request, void* argument) noexcept override {
    if (unplugged) return fail(ENODEV);
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& about = *static_cast<v4l2_capability*>(argument);
        about.capabilities = caps | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_DEVICE_CAPS;
        about.device_caps = caps;
        std::strcpy(reinterpret_cast<char*>(about.card), "Eye");
        return device ? 0 : fail(ENOTTY);
      }
      case VIDIOC_ENUM_FMT: {
        auto& one = *static_cast<v4l2_fmtdesc*>(argument);
        if (one.index >= offers.size()) return fail(EINVAL);
        one.pixelformat = offers[one.index].fourcc;
        return 0;
      }
      case VIDIOC_ENUM_FRAMESIZES: {
        auto& one = *static_cast<v4l2_frmsizeenum*>(argument);
        for (const Offer& offer : offers) {
          if (offer.fourcc != one.pixel_format || one.index >= offer.sizes.size()) continue;
          one.type = V4L2_FRMSIZE_TYPE_DISCRETE;
          one.discrete.width = offer.sizes[one.index].first;
          one.discrete.height = offer.sizes[one.index].second;
          return 0;
        }
        return fail(EINVAL);
      }
      case VIDIOC_S_FMT: {  // a driver gives what is nearest
        auto& pixels = static_cast<v4l2_format*>(argument)->fmt.pix;
        for (const Offer& offer : offers) {
          if (offer.fourcc != pixels.pixelformat) continue;
          auto nearest = offer.sizes.front();
          for (const auto& size : offer.sizes) {
            if (size == std::pair(pixels.width, pixels.height)) nearest = size;
          }
          pixels.width = nearest.first;
          pixels.height = nearest.second;
          pixels.bytesperline = pixels.width * 2;
          format = offer.fourcc;
          return 0;
        }
        return fail(EINVAL);
      }
      case VIDIOC_REQBUFS:
        return 0;
      case VIDIOC_QUERYBUF: {
        auto& buffer = *static_cast<v4l2_buffer*>(argument);
        buffer.length = buffer_bytes;
        buffer.m.offset = buffer.index * 4096;
        return 0;
      }
      case VIDIOC_QBUF:
        free_.push_back(static_cast<v4l2_buffer*>(argument)->index);
        EXPECT_LE(free_.size() + done_.size(), 4U) << "a buffer was given twice";
        return 0;
      case VIDIOC_DQBUF:
        if (done_.empty()) return fail(EAGAIN);
        *static_cast<v4l2_buffer*>(argument) = done_.front();
        done_.pop_front();
        return 0;
      case VIDIOC_STREAMON:
        streaming = true;
        return 0;
      case VIDIOC_STREAMOFF:
        streaming = false;
        return 0;
      default:
        return fail(ENOTTY);
    }
  }

 private:
  static int fail(int error) {
    errno = error;
    return -1;
  }

  std::byte memory_[4][64] = {};
  std::deque<std::uint32_t> free_;
  std::deque<v4l2_buffer> done_;
  std::uint32_t sequence_ = 0;
};

class VideoDeviceTest : public testing::Test {
 protected:
  std::unique_ptr<VideoDevice> start() {
    auto device = open_video({"/dev/video9", 640, 480}, driver_);
    EXPECT_TRUE(device) << device.error().message;
    return device ? std::move(device).value() : nullptr;
  }
  std::string refusal() {
    auto device = open_video({"/dev/video9", 640, 480}, driver_);
    EXPECT_FALSE(device);
    EXPECT_EQ(driver_.opened, driver_.closed);
    return device ? "" : device.error().message;
  }

  FakeDriver driver_;
};

TEST_F(VideoDeviceTest, StreamsUntilItIsDestroyed) {
  auto device = start();
  EXPECT_TRUE(driver_.streaming);
  EXPECT_EQ(driver_.mapped.size(), 4U);
  device.reset();
  EXPECT_FALSE(driver_.streaming);
  EXPECT_TRUE(driver_.mapped.empty());
  EXPECT_EQ(driver_.closed, 1);
}

TEST_F(VideoDeviceTest, GivesAnImageWithTheDriversStamp) {
  const auto device = start();
  driver_.expose(std::byte{5}, 12'000'001);
  const auto frame = device->next(0);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->stamp_ns, 12'000'001'000);
  EXPECT_TRUE(frame->stamped_by_driver);
  EXPECT_EQ(frame->format, VideoFormat::kYuyv);
  EXPECT_EQ(frame->row_bytes, 1280U);
  EXPECT_EQ(frame->bytes.size(), 16U);
  EXPECT_EQ(frame->bytes[0], std::byte{5});
}

// Images 1 to 3 wait; 3 is given, 1 and 2 are skipped, and no buffer is lost.
TEST_F(VideoDeviceTest, GivesTheNewestAndReturnsEveryBuffer) {
  const auto device = start();
  for (int round = 0; round < 10; ++round) {
    for (const int value : {1, 2, 3}) driver_.expose(std::byte(value), value);
    const auto frame = device->next(0);
    ASSERT_TRUE(frame) << round;
    EXPECT_EQ(frame->bytes[0], std::byte{3});
    EXPECT_EQ(frame->skipped, round == 0 ? 0U : 2U);
  }
}

TEST_F(VideoDeviceTest, SaysThatNoImageCame) {
  const auto device = start();
  EXPECT_EQ(device->next(monotonic_ns() + 1'000'000).error().code, ErrorCode::kBusy);
}

TEST_F(VideoDeviceTest, StampsAnImageItselfWhenTheDriverDoesNot) {
  driver_.stamp_flags = V4L2_BUF_FLAG_TIMESTAMP_COPY;
  const auto device = start();
  const std::int64_t before = monotonic_ns();
  driver_.expose(std::byte{1}, 1);
  const auto frame = device->next(0);
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->stamped_by_driver);
  EXPECT_GE(frame->stamp_ns, before);
}

TEST_F(VideoDeviceTest, PassesOnThatAnImageIsDamaged) {
  const auto device = start();
  driver_.expose(std::byte{1}, 1, V4L2_BUF_FLAG_ERROR);
  EXPECT_TRUE(device->next(0)->damaged);
}

TEST_F(VideoDeviceTest, SaysThatTheCameraWasUnplugged) {
  const auto device = start();
  driver_.unplugged = true;
  EXPECT_EQ(device->next(0).error().code, ErrorCode::kNotFound);
}

TEST_F(VideoDeviceTest, PrefersGreyToWhatMustBeDecoded) {
  driver_.offers = {{V4L2_PIX_FMT_MJPEG, {{640, 480}}},
                    {V4L2_PIX_FMT_YUYV, {{640, 480}}},
                    {V4L2_PIX_FMT_GREY, {{640, 480}}}};
  start();
  EXPECT_EQ(driver_.format, V4L2_PIX_FMT_GREY);
}

TEST_F(VideoDeviceTest, TakesAnotherFormatForTheRightSize) {
  driver_.offers = {{V4L2_PIX_FMT_YUYV, {{320, 240}}}, {V4L2_PIX_FMT_MJPEG, {{640, 480}}}};
  start();
  EXPECT_EQ(driver_.format, V4L2_PIX_FMT_MJPEG);
}

TEST_F(VideoDeviceTest, NamesTheSizesThatThereAre) {
  driver_.offers = {{V4L2_PIX_FMT_YUYV, {{320, 240}, {1280, 720}}}};
  EXPECT_THAT(refusal(), AllOf(HasSubstr("/dev/video9: does not give 640x480"),
                               HasSubstr("it has YUYV (320x240, 1280x720)")));
}

TEST_F(VideoDeviceTest, NamesTheFormatsThatThereAre) {
  driver_.offers = {{V4L2_PIX_FMT_H264, {{640, 480}}}, {V4L2_PIX_FMT_NV12, {}}};
  EXPECT_THAT(refusal(), AllOf(HasSubstr("expected GREY, YUYV or MJPEG"),
                               HasSubstr("it has H264 (640x480), NV12")));
}

// vivid has 59 formats, one of them GREY.
TEST_F(VideoDeviceTest, NamesOnlyFormatsThatAreReadHereIfThereAreSome) {
  driver_.offers = {{V4L2_PIX_FMT_NV12, {{320, 240}}}, {V4L2_PIX_FMT_GREY, {{320, 240}}}};
  EXPECT_THAT(refusal(), HasSubstr("it has GREY (320x240); calibrate"));
}

TEST_F(VideoDeviceTest, NamesAtMostEightFormats) {
  driver_.offers.assign(10, {V4L2_PIX_FMT_NV12, {}});
  EXPECT_THAT(refusal(), HasSubstr("NV12, NV12 and 2 more"));
}

TEST_F(VideoDeviceTest, RefusesTheMetadataNodeOfACamera) {
  driver_.caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_THAT(refusal(), AllOf(HasSubstr("of \"Eye\""), HasSubstr("for metadata")));
}

TEST_F(VideoDeviceTest, RefusesWhatIsNoVideoDevice) {
  driver_.device = false;
  EXPECT_THAT(refusal(), HasSubstr("is no video device"));
}

TEST_F(VideoDeviceTest, SaysWhyItCannotBeOpened) {
  driver_.open_error = ENOENT;
  EXPECT_THAT(refusal(), HasSubstr("no such device; ls /dev/video*"));
  driver_.open_error = EACCES;
  EXPECT_THAT(refusal(), HasSubstr("usermod -aG video"));
  driver_.open_error = EBUSY;
  EXPECT_THAT(refusal(), HasSubstr("in use by another program"));
}

TEST_F(VideoDeviceTest, RefusesABufferWithoutBytes) {
  driver_.buffer_bytes = 0;
  EXPECT_THAT(refusal(), HasSubstr("has buffers of 0 bytes"));
}

TEST(VideoDevice, OfAFileThatIsNoneIsRefusedByName) {
  EXPECT_THAT(VideoDevice::open({"/dev/null", 640, 480}).error().message,
              HasSubstr("/dev/null: is no video device"));
  EXPECT_THAT(VideoDevice::open({"/dev/video987", 640, 480}).error().message,
              HasSubstr("/dev/video987: no such device"));
}

}  // namespace
}  // namespace zonepack
