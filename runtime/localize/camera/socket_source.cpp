// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/socket_source.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "platform/process/clock.hpp"
#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {
namespace {

constexpr std::string_view kImageMagic = "ZPI1";
constexpr std::uint32_t kJpegHeadBytes = 64 * 1024;  // tables and notes of a small JPEG
constexpr unsigned kSocketMode = 0660;
constexpr int kMostWait_ms = 100;
constexpr std::uint64_t kMostTaken = 8;  // images of a fast writer before one is looked at

// Little-endian.
template <typename T>
T little_endian_at(ByteSpan bytes, std::size_t at) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value |= std::to_integer<std::uint64_t>(bytes[at + i]) << (8 * i);
  }
  return static_cast<T>(value);
}

// The most that an image of this size takes in any format, a quarter of each row for padding.
std::size_t most_image_bytes(int width, int height) noexcept {
  return (std::size_t{4} * static_cast<std::size_t>(width)) * static_cast<std::size_t>(height) +
         kJpegHeadBytes;
}

}  // namespace

SocketSource::SocketSource(std::string name, LocalListener listener, int width, int height)
    : name_(std::move(name)),
      width_(width),
      height_(height),
      most_bytes_(most_image_bytes(width, height)),
      listener_(std::move(listener)),
      piece_(kMostPieceBytes) {}

Outcome<std::unique_ptr<ImageSource>> SocketSource::open(const std::string& path, int width,
                                                         int height) {
  Result<LocalListener> listener = LocalListener::listen(path, kSocketMode);
  if (!listener) {
    switch (listener.error().code) {
      case ErrorCode::kExists:
        return failure(path + ": another program listens there, or it is no socket; name another");
      case ErrorCode::kTooLarge:
        return failure(path + ": is longer than " + std::to_string(LocalListener::kMostPath) +
                       " bytes, which no socket's name may be");
      default:
        return failure(path + ": cannot be made: " + reason_text(listener.error()), ErrorCode::kIo);
    }
  }
  return std::unique_ptr<ImageSource>(
      new SocketSource("socket:" + path, std::move(listener).value(), width, height));
}

// The newest writer waits for the one that is there: two cameras are a mistake.
void SocketSource::accept() {
  Result<LocalSocket> comer = listener_.accept();
  if (!comer) return;
  if (!writer_.is_open()) {
    writer_ = std::move(comer).value();
    arriving_.reset();
    return;
  }
  constexpr std::string_view kTaken = "another program writes images here";
  static_cast<void>(comer->send(std::as_bytes(std::span(kTaken))));
}

void SocketSource::hang_up(const std::string& why) {
  if (!why.empty()) static_cast<void>(writer_.send(std::as_bytes(std::span(why))));
  writer_.close();
  arriving_.reset();
  bytes_.clear();
}

Outcome<SocketSource::Header> SocketSource::parse_header(ByteSpan packet) const {
  if (packet.size() != kHeaderBytes ||
      std::memcmp(packet.data(), kImageMagic.data(), kImageMagic.size()) != 0) {
    return failure("expected a header of 32 bytes that begins with ZPI1, got " +
                   std::to_string(packet.size()) + " bytes");
  }
  Header header;
  header.bytes = little_endian_at<std::uint32_t>(packet, 4);
  const auto width = little_endian_at<std::uint32_t>(packet, 8);
  const auto height = little_endian_at<std::uint32_t>(packet, 12);
  header.image.row_bytes = little_endian_at<std::uint32_t>(packet, 16);
  const auto format = little_endian_at<std::uint8_t>(packet, 20);
  const auto clock = little_endian_at<std::uint8_t>(packet, 21);
  header.stamp_ns = little_endian_at<std::int64_t>(packet, 24);
  if (format > static_cast<std::uint8_t>(PixelFormat::kJpeg) ||
      clock > static_cast<std::uint8_t>(ImageClock::kRealtime) ||
      little_endian_at<std::uint16_t>(packet, 22) != 0) {
    return failure("format " + std::to_string(format) + ", clock " + std::to_string(clock) +
                   "; expected format 0 to 4, clock 0 to 2 and zeros behind them");
  }
  if (width != static_cast<std::uint32_t>(width_) ||
      height != static_cast<std::uint32_t>(height_)) {
    return failure("an image of " + size_text(width, height) + "; the calibration is of " +
                   size_text(width_, height_));
  }
  header.image.format = static_cast<PixelFormat>(format);
  header.image.width = width_;
  header.image.height = height_;
  header.clock = static_cast<ImageClock>(clock);
  const std::uint64_t least = least_row_bytes(header.image.format, width_);
  const std::uint64_t raw =
      std::uint64_t{header.image.row_bytes} * static_cast<std::uint64_t>(height_);
  const bool jpeg = header.image.format == PixelFormat::kJpeg;
  if (header.bytes == 0 || header.bytes > most_bytes_ ||
      (!jpeg && (header.image.row_bytes < least || raw != header.bytes))) {
    return failure(std::to_string(header.bytes) + " bytes with rows of " +
                   std::to_string(header.image.row_bytes) + "; expected " +
                   (jpeg ? "1 to " + std::to_string(most_bytes_)
                         : "rows of " + std::to_string(least) +
                               " or more, and height times that, at most " +
                               std::to_string(most_bytes_)));
  }
  return header;
}

// A packet of `got` bytes came. Fails when the writer breaks the protocol.
Outcome<void> SocketSource::fill(std::size_t got) {
  const ByteSpan packet = std::span(piece_).first(got);
  last_piece_ns_ = monotonic_ns();
  if (!arriving_) {
    const Outcome<Header> header = parse_header(packet);
    if (!header) return header.error();
    arriving_ = *header;
    bytes_.clear();
    bytes_.reserve(header->bytes);
    return {};
  }
  if (got > arriving_->bytes - bytes_.size()) {
    return failure("more bytes than the image's header says");
  }
  bytes_.insert(bytes_.end(), packet.begin(), packet.end());
  if (bytes_.size() == arriving_->bytes) {
    std::swap(bytes_, whole_);
    complete_ = std::exchange(arriving_, std::nullopt);
  }
  return {};
}

ImageSource::News SocketSource::next(std::int64_t until_ns, GreyImage& into) {
  News news;
  complete_.reset();
  std::uint64_t taken = 0;  // whole images
  for (;;) {
    accept();
    // What waits is taken, so that a writer is not held up and the newest image counts.
    while (writer_.is_open() && taken < kMostTaken) {
      const Result<LocalSocket::Received> got = writer_.receive(piece_);
      if (!got && got.error().code == ErrorCode::kBusy) break;
      if (!got || got->bytes == 0) {
        const bool in_the_middle = arriving_.has_value();
        hang_up({});
        if (in_the_middle) {
          return {State::kRefused, name_ + ": the writer closed in the middle of an image"};
        }
        break;
      }
      const Outcome<void> filled =
          got->cut ? failure("a packet of more than 65536 bytes") : fill(got->bytes);
      if (!filled) {
        hang_up(filled.error().message);
        return {State::kRefused,
                name_ + ": the writer was disconnected: " + filled.error().message};
      }
      taken += complete_ && !arriving_ ? 1 : 0;
      if (monotonic_ns() >= until_ns) break;
    }
    if (complete_) break;
    const std::int64_t now_ns = monotonic_ns();
    if (arriving_ && now_ns - last_piece_ns_ > kPatience_ns) {
      const std::string why = "nothing for 1 s in the middle of an image";
      hang_up(why);
      return {State::kRefused, name_ + ": the writer was disconnected: " + why};
    }
    if (now_ns >= until_ns) return news;
    const auto left_ms = static_cast<int>(
        std::clamp<std::int64_t>((until_ns - now_ns) / 1'000'000, 1, kMostWait_ms));
    if (writer_.is_open()) {
      writer_.wait(false, left_ms);
    } else {
      sleep_until_ns(std::min(until_ns, now_ns + 10'000'000));
    }
  }
  news.skipped = taken - 1;
  header_ = *complete_;
  header_.image.bytes = whole_;
  if (auto made = to_grey(header_.image, name_, into); !made) {
    return {State::kRefused, made.error().message, news.skipped};
  }
  into.stamp_ns = header_.stamp_ns;
  news.state = State::kImage;
  return news;
}

}  // namespace zonepack::localize
