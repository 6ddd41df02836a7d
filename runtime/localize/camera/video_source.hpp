// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "platform/devices/video_device.hpp"
#include "runtime/localize/camera/image_source.hpp"

namespace zonepack::localize {

// The images of a V4L2 camera as grey.
class VideoSource final : public ImageSource {
 public:
  VideoSource(std::string name, std::unique_ptr<VideoDevice> device)
      : name_(std::move(name)), device_(std::move(device)) {}

  News next(std::int64_t until_ns, GreyImage& into) override;
  ImageClock clock() const noexcept override { return ImageClock::kMonotonic; }

 private:
  const std::string name_;
  const std::unique_ptr<VideoDevice> device_;
};

}  // namespace zonepack::localize
