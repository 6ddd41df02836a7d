// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "platform/base/byte_span.hpp"
#include "platform/base/failure.hpp"

namespace zonepack {

enum class VideoFormat : std::uint8_t { kGrey, kYuyv, kMjpeg };
const char* to_string(VideoFormat format) noexcept;  // "GREY", "YUYV", "MJPEG"

struct VideoSettings {
  std::string path;  // "/dev/video0"
  int width = 0, height = 0;
};

// One image as the driver left it.
struct VideoFrame {
  ByteSpan bytes;  // valid until the next call
  VideoFormat format = VideoFormat::kGrey;
  int width = 0, height = 0;
  std::uint32_t row_bytes = 0;     // of kGrey and kYuyv: from a row to the next
  std::int64_t stamp_ns = 0;       // CLOCK_MONOTONIC
  bool stamped_by_driver = false;  // else when it was taken from the driver
  bool damaged = false;            // the driver says so
  std::uint32_t skipped = 0;       // images since the last one that nobody saw
};

// A camera by the kernel's own interface (V4L2): one plane, streaming from kBuffers mapped buffers.
//
// Threads: one.
// Memory: the driver's buffers, mapped.
class VideoDevice {
 public:
  static constexpr unsigned kBuffers = 4;

  // Starts the camera in the first format of GREY, YUYV, MJPEG that it gives in exactly this size.
  // A failure names the device, what is wrong and what the device has.
  static Outcome<std::unique_ptr<VideoDevice>> open(const VideoSettings& settings);

  virtual ~VideoDevice() = default;
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  // Waits for an image until monotonic_ns() reaches the time; of several that wait, the newest.
  // kBusy: none came. kNotFound: the camera was unplugged. kIo with errno.
  virtual Result<VideoFrame> next(std::int64_t until_ns) noexcept = 0;

 protected:
  VideoDevice() = default;
};

}  // namespace zonepack
