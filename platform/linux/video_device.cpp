// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/video_device.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "platform/linux/video_calls.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kMostBufferBytes = std::size_t{64} << 20;
constexpr std::size_t kMostNamed = 8;      // formats in a message
constexpr std::uint32_t kMostListed = 64;  // formats or sizes, of a driver that never ends its list

struct Known {
  VideoFormat format;
  std::uint32_t fourcc;
};
// In order of preference: what is grey already, what has grey in it, what must be decoded.
constexpr std::array kKnown{
    Known{VideoFormat::kGrey, V4L2_PIX_FMT_GREY}, Known{VideoFormat::kYuyv, V4L2_PIX_FMT_YUYV},
    Known{VideoFormat::kMjpeg, V4L2_PIX_FMT_MJPEG}, Known{VideoFormat::kMjpeg, V4L2_PIX_FMT_JPEG}};

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto c = static_cast<char>((fourcc >> shift) & 0x7F);
    text += c > ' ' && c < 0x7F ? c : '?';
  }
  return text;
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

class Device final : public VideoDevice {
 public:
  Device(VideoCalls& calls, const VideoSettings& settings) : calls_(calls), settings_(settings) {}

  ~Device() override {
    if (fd_ < 0) return;
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (streaming_) calls_.control(fd_, VIDIOC_STREAMOFF, &type);
    for (const Mapped& buffer : buffers_) calls_.unmap(buffer.at, buffer.bytes);
    calls_.close(fd_);
  }

  Outcome<void> start();
  Result<VideoFrame> next(std::int64_t until_ns) noexcept override;

 private:
  struct Mapped {
    void* at;
    std::size_t bytes;
  };

  Failure refused(const std::string& what) const { return failure(settings_.path + ": " + what); }
  Failure failed(const char* doing, int error) const {
    return failure(settings_.path + ": " + doing + ": " + std::strerror(error), ErrorCode::kIo);
  }
  Outcome<void> check_kind();
  std::vector<std::uint32_t> formats();
  std::string offers(const std::vector<std::uint32_t>& formats);
  bool set(const Known& known);
  Outcome<void> choose_format();
  Outcome<void> map_buffers();
  bool give_back(std::uint32_t index) noexcept;
  std::optional<Error> take(v4l2_buffer& buffer) noexcept;

  VideoCalls& calls_;
  const VideoSettings settings_;
  int fd_ = -1;
  bool streaming_ = false;
  VideoFormat format_ = VideoFormat::kGrey;
  std::uint32_t row_bytes_ = 0;
  std::vector<Mapped> buffers_;
  std::optional<std::uint32_t> held_;  // the buffer that the caller reads
  std::optional<std::uint32_t> last_sequence_;
};

Outcome<void> Device::start() {
  fd_ = calls_.open(settings_.path.c_str());
  if (fd_ < 0) {
    const int error = errno;
    switch (error) {
      case ENOENT:
      case ENXIO:
      case ENODEV:
        return failure(settings_.path + ": no such device; ls /dev/video* lists those there are",
                       ErrorCode::kNotFound);
      case EACCES:
        return refused(
            "may not be opened by this user; members of its group may (usermod -aG video USER)");
      case EBUSY:
        return refused("is in use by another program; fuser -v " + settings_.path + " names it");
      default:
        return failed("cannot be opened", error);
    }
  }
  if (auto kind = check_kind(); !kind) return kind;
  if (auto chosen = choose_format(); !chosen) return chosen;
  if (auto mapped = map_buffers(); !mapped) return mapped;
  for (std::uint32_t i = 0; i < buffers_.size(); ++i) {
    if (!give_back(i)) return failed("takes no buffer", errno);
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (calls_.control(fd_, VIDIOC_STREAMON, &type) < 0) return failed("does not start", errno);
  streaming_ = true;
  return {};
}

Outcome<void> Device::check_kind() {
  v4l2_capability about{};
  if (!calls_.is_device(fd_) || calls_.control(fd_, VIDIOC_QUERYCAP, &about) < 0) {
    return refused("is no video device; expected one of /dev/video*");
  }
  const std::uint32_t can =
      (about.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? about.device_caps : about.capabilities;
  const std::string card(reinterpret_cast<const char*>(about.card),
                         strnlen(reinterpret_cast<const char*>(about.card), sizeof about.card));
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    return refused("gives no images (of \"" + card + "\"): it is " +
                   ((can & V4L2_CAP_META_CAPTURE) != 0 ? "for metadata; the camera is its neighbour"
                    : (can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0
                        ? "of several planes, which is not supported"
                        : "not a capture device") +
                   "; expected a capture device of one plane");
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    return refused("\"" + card + "\" cannot stream into mapped buffers");
  }
  return {};
}

std::vector<std::uint32_t> Device::formats() {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < kMostListed; ++i) {
    v4l2_fmtdesc one{};
    one.index = i;
    one.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (calls_.control(fd_, VIDIOC_ENUM_FMT, &one) < 0) break;
    all.push_back(one.pixelformat);
  }
  return all;
}

// "YUYV (640x480, 1280x720), MJPG (1920x1080)"; of many formats the first kMostNamed.
std::string Device::offers(const std::vector<std::uint32_t>& formats) {
  std::string text;
  std::size_t named = 0;
  for (const std::uint32_t format : formats) {
    if (++named > kMostNamed)
      return text + " and " + std::to_string(formats.size() - kMostNamed) + " more";
    std::string sizes;
    for (std::uint32_t i = 0; i < kMostListed; ++i) {
      v4l2_frmsizeenum size{};
      size.index = i;
      size.pixel_format = format;
      if (calls_.control(fd_, VIDIOC_ENUM_FRAMESIZES, &size) < 0) break;
      sizes += sizes.empty() ? "" : ", ";
      if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
        sizes += size_text(size.discrete.width, size.discrete.height);
        continue;
      }
      sizes += size_text(size.stepwise.min_width, size.stepwise.min_height) + " to " +
               size_text(size.stepwise.max_width, size.stepwise.max_height);
      break;
    }
    text += (text.empty() ? "" : ", ") + fourcc_text(format);
    if (!sizes.empty()) text += " (" + sizes + ")";
  }
  return text.empty() ? "nothing" : text;
}

// Whether the driver now gives this format in exactly the wanted size.
bool Device::set(const Known& known) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.width = static_cast<std::uint32_t>(settings_.width);
  pixels.height = static_cast<std::uint32_t>(settings_.height);
  pixels.pixelformat = known.fourcc;
  pixels.field = V4L2_FIELD_NONE;
  if (calls_.control(fd_, VIDIOC_S_FMT, &format) < 0) return false;
  if (pixels.pixelformat != known.fourcc || pixels.field != V4L2_FIELD_NONE ||
      pixels.width != static_cast<std::uint32_t>(settings_.width) ||
      pixels.height != static_cast<std::uint32_t>(settings_.height)) {
    return false;
  }
  format_ = known.format;
  const std::uint32_t least = pixels.width * (format_ == VideoFormat::kYuyv ? 2 : 1);
  row_bytes_ = std::max(pixels.bytesperline, least);
  return true;
}

Outcome<void> Device::choose_format() {
  std::vector<std::uint32_t> has = formats();
  bool readable = false;
  for (const Known& known : kKnown) {
    if (std::find(has.begin(), has.end(), known.fourcc) == has.end()) continue;
    readable = true;
    if (set(known)) return {};
    if (errno == EBUSY) return refused("is in use by another program");
  }
  if (readable) {
    std::erase_if(has, [](std::uint32_t fourcc) {
      return std::ranges::find(kKnown, fourcc, &Known::fourcc) == kKnown.end();
    });
  }
  const std::string wanted = size_text(static_cast<std::uint32_t>(settings_.width),
                                       static_cast<std::uint32_t>(settings_.height));
  return refused((readable ? "does not give " + wanted + " in GREY, YUYV or MJPEG"
                           : "has no format that is read here; expected GREY, YUYV or MJPEG") +
                 "; it has " + offers(has) +
                 (readable ? "; calibrate the camera for a size that it has" : ""));
}

Outcome<void> Device::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (calls_.control(fd_, VIDIOC_REQBUFS, &request) < 0) {
    return errno == EBUSY ? refused("is in use by another program")
                          : failed("gives no buffers", errno);
  }
  if (request.count < 2) return refused("gives fewer than two buffers");
  for (std::uint32_t i = 0; i < std::min(request.count, kBuffers); ++i) {
    v4l2_buffer buffer{};
    buffer.index = i;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (calls_.control(fd_, VIDIOC_QUERYBUF, &buffer) < 0) return failed("hides a buffer", errno);
    if (buffer.length == 0 || buffer.length > kMostBufferBytes) {
      return refused("has buffers of " + std::to_string(buffer.length) + " bytes");
    }
    void* const at = calls_.map(fd_, buffer.length, buffer.m.offset);
    if (at == nullptr) return failed("cannot be mapped", errno);
    buffers_.push_back({at, buffer.length});
  }
  return {};
}

bool Device::give_back(std::uint32_t index) noexcept {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return calls_.control(fd_, VIDIOC_QBUF, &buffer) == 0;
}

std::optional<Error> Device::take(v4l2_buffer& buffer) noexcept {
  buffer = {};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (calls_.control(fd_, VIDIOC_DQBUF, &buffer) == 0) {
    if (buffer.index < buffers_.size()) return std::nullopt;
    return Error{ErrorCode::kBadValue, buffer.index};
  }
  if (errno == EAGAIN) return Error{ErrorCode::kBusy, 0};
  if (errno == ENODEV || errno == ENXIO) return Error{ErrorCode::kNotFound, errno};
  return Error{ErrorCode::kIo, errno};
}

Result<VideoFrame> Device::next(std::int64_t until_ns) noexcept {
  if (held_) {
    const std::uint32_t index = *std::exchange(held_, std::nullopt);
    if (!give_back(index)) {
      return {errno == ENODEV ? ErrorCode::kNotFound : ErrorCode::kIo, errno};
    }
  }
  v4l2_buffer buffer{}, newer{};
  for (;;) {
    const auto error = take(buffer);
    if (!error) break;
    if (error->code != ErrorCode::kBusy) return *error;
    const std::int64_t left_ns = until_ns - monotonic_ns();
    if (left_ns <= 0) return ErrorCode::kBusy;
    const auto left_ms = static_cast<int>(std::clamp<std::int64_t>(left_ns / 1'000'000, 1, 1000));
    if (calls_.wait(fd_, left_ms) < 0) return {ErrorCode::kIo, errno};
  }
  // Bounded: no more can wait than there are buffers.
  for (std::size_t i = 1; i < buffers_.size() && !take(newer); ++i) {
    if (!give_back(buffer.index)) return {ErrorCode::kIo, errno};
    buffer = newer;
  }
  held_ = buffer.index;
  VideoFrame frame;
  const Mapped& mapped = buffers_[buffer.index];
  frame.bytes = {static_cast<const std::byte*>(mapped.at),
                 std::min<std::size_t>(buffer.bytesused, mapped.bytes)};
  frame.format = format_;
  frame.width = settings_.width;
  frame.height = settings_.height;
  frame.row_bytes = row_bytes_;
  frame.stamped_by_driver =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  frame.stamp_ns = frame.stamped_by_driver ? std::int64_t{buffer.timestamp.tv_sec} * 1'000'000'000 +
                                                 std::int64_t{buffer.timestamp.tv_usec} * 1000
                                           : monotonic_ns();
  frame.damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  if (last_sequence_) frame.skipped = std::max(buffer.sequence - *last_sequence_, 1U) - 1;
  last_sequence_ = buffer.sequence;
  return frame;
}

}  // namespace

const char* to_string(VideoFormat format) noexcept {
  switch (format) {
    case VideoFormat::kGrey:
      return "GREY";
    case VideoFormat::kYuyv:
      return "YUYV";
    case VideoFormat::kMjpeg:
      return "MJPEG";
  }
  return "?";
}

Outcome<std::unique_ptr<VideoDevice>> open_video(const VideoSettings& settings, VideoCalls& calls) {
  auto device = std::make_unique<Device>(calls, settings);
  if (auto started = device->start(); !started) return started.error();
  return std::unique_ptr<VideoDevice>(std::move(device));
}

}  // namespace zonepack
