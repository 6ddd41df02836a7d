// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/devices/video_device.hpp"

namespace zonepack {

// The system calls that a VideoDevice makes, each as in its manual page: -1 and errno on failure. A
// test puts a device of its own in their place.
class VideoCalls {
 public:
  virtual ~VideoCalls() = default;
  virtual int open(const char* path) noexcept = 0;
  virtual bool is_device(int fd) noexcept = 0;
  virtual int control(int fd, unsigned long request, void* argument) noexcept = 0;
  virtual void* map(int fd, std::size_t bytes, std::int64_t offset) noexcept = 0;  // null: failed
  virtual void unmap(void* at, std::size_t bytes) noexcept = 0;
  // Milliseconds; 1: readable, 0: not yet, -1.
  virtual int wait(int fd, int timeout_ms) noexcept = 0;
  virtual void close(int fd) noexcept = 0;
};

// What VideoDevice::open() does, by these calls, which outlive the device.
Outcome<std::unique_ptr<VideoDevice>> open_video(const VideoSettings& settings, VideoCalls& calls);

}  // namespace zonepack
