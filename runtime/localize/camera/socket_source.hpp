// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/process/local_socket.hpp"
#include "runtime/localize/camera/image_source.hpp"
#include "runtime/localize/camera/raw_image.hpp"

namespace zonepack::localize {

// Images that another program writes to a local socket (CAMERA.md, byte by byte). One writer at a
// time. One that breaks the protocol, or stops in the middle of an image for kPatience_ns, is sent
// a text that says why, and disconnected; the next may come.
//
// Memory: two images of the calibration's size as they come, the newest whole one and the next; a
// header that asks for more is refused before anything is taken.
class SocketSource final : public ImageSource {
 public:
  static constexpr std::size_t kHeaderBytes = 32;
  static constexpr std::size_t kMostPieceBytes = 65'536;
  static constexpr std::int64_t kPatience_ns = 1'000'000'000;

  static Outcome<std::unique_ptr<ImageSource>> open(const std::string& path, int width, int height);

  News next(std::int64_t until_ns, GreyImage& into) override;
  ImageClock clock() const noexcept override { return header_.clock; }

 private:
  struct Header {
    RawImage image;
    std::uint32_t bytes = 0;
    std::int64_t stamp_ns = 0;
    ImageClock clock = ImageClock::kMonotonic;
  };

  SocketSource(std::string name, LocalListener listener, int width, int height);
  void accept();
  Outcome<void> fill(std::size_t got);
  Outcome<Header> parse_header(ByteSpan packet) const;
  void hang_up(const std::string& why);

  const std::string name_;
  const int width_, height_;
  const std::size_t most_bytes_;
  LocalListener listener_;
  LocalSocket writer_;
  Header header_;                   // of the image that was given last
  std::optional<Header> arriving_;  // of the image that is on its way
  std::vector<std::byte> bytes_;    // of it, and of the newest whole one
  std::vector<std::byte> whole_;
  std::optional<Header> complete_;
  std::vector<std::byte> piece_;
  std::int64_t last_piece_ns_ = 0;
};

}  // namespace zonepack::localize
