// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/video_source.hpp"

#include "runtime/localize/camera/raw_image.hpp"

namespace zonepack::localize {
namespace {

PixelFormat pixels_of(VideoFormat format) noexcept {
  switch (format) {
    case VideoFormat::kYuyv:
      return PixelFormat::kYuyv;
    case VideoFormat::kMjpeg:
      return PixelFormat::kJpeg;
    case VideoFormat::kGrey:
      break;
  }
  return PixelFormat::kGrey;
}

}  // namespace

ImageSource::News VideoSource::next(std::int64_t until_ns, GreyImage& into) {
  const Result<VideoFrame> frame = device_->next(until_ns);
  if (!frame) {
    switch (frame.error().code) {
      case ErrorCode::kBusy:
        return {};
      case ErrorCode::kNotFound:
        return {State::kBroken, name_ + ": the camera was unplugged; plug it in and start again"};
      default:
        return {State::kBroken, name_ + ": gives no images: " + reason_text(frame.error())};
    }
  }
  if (frame->damaged) {
    return {State::kRefused, name_ + ": the driver calls an image damaged; see the camera's cable",
            frame->skipped};
  }
  const RawImage raw{pixels_of(frame->format), frame->width, frame->height, frame->row_bytes,
                     frame->bytes};
  if (auto made = to_grey(raw, name_, into); !made) {
    return {State::kRefused, made.error().message, frame->skipped};
  }
  into.stamp_ns = frame->stamp_ns;
  return {State::kImage, {}, frame->skipped};
}

}  // namespace zonepack::localize
