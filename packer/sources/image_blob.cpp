// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/image_blob.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace zonepack::packer {
namespace {

using Span = std::span<const std::byte>;

constexpr std::string_view kPngMagic("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpegMagic("\xff\xd8\xff", 3);
constexpr std::string_view kJpegEnd("\xff\xd9", 2);
constexpr std::string_view kRvlMagic = "DEPTHRVL";
constexpr std::string_view kInverseMagic = "DEPTHINV";
constexpr std::size_t kDepthHeaderBytes = 16;
// A depth image of more pixels than this is no camera's.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

std::string_view text(Span bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t big_endian(Span bytes) {
  std::uint32_t value = 0;
  for (const std::byte b : bytes.first(4)) value = value << 8 | static_cast<std::uint32_t>(b);
  return value;
}

void check_jpeg(Span bytes, const Place& place) {
  if (text(bytes).rfind(kJpegEnd) == std::string_view::npos) {
    place.damaged("expected a whole JPEG, found one without its end marker");
  }
}

// Walks the chunks: each is length, type, data, CRC of type and data; the last one is IEND.
void check_png(Span bytes, const Place& place) {
  Span rest = bytes.subspan(kPngMagic.size());
  while (rest.size() >= 12) {
    const std::size_t length = big_endian(rest);
    if (length > rest.size() - 12) break;
    const Span body = rest.subspan(4, length + 4);
    const auto crc =
        crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    if (crc != big_endian(rest.subspan(8 + length))) {
      place.damaged("expected a PNG whose parts match their checksums");
    }
    if (text(body).starts_with("IEND")) return;
    rest = rest.subspan(12 + length);
  }
  place.damaged("expected a whole PNG, found one cut short");
}

// RVL: runs of zero pixels, then runs of deltas, all counts and deltas as 3-bit groups with a
// continuation bit, eight nibbles to a word, high nibble first. Walked without keeping a pixel.
class RvlWalk {
 public:
  explicit RvlWalk(Span words) : words_(words) {}

  bool covers(std::uint64_t pixels) {
    while (pixels > 0) {
      const auto zeros = number();
      if (zeros < 0 || static_cast<std::uint64_t>(zeros) > pixels) return false;
      pixels -= static_cast<std::uint64_t>(zeros);
      const auto deltas = number();
      if (deltas < 0 || static_cast<std::uint64_t>(deltas) > pixels) return false;
      if (zeros == 0 && deltas == 0) return false;
      pixels -= static_cast<std::uint64_t>(deltas);
      for (std::int64_t i = 0; i < deltas; ++i) {
        if (number() < 0) return false;
      }
    }
    return true;
  }

 private:
  // -1 at the end of the stream or when a number does not fit 32 bits.
  std::int64_t number() {
    std::int64_t value = 0;
    for (int shift = 0; shift < 32; shift += 3) {
      if (left_ == 0) {
        if (words_.size() < 4) return -1;
        std::memcpy(&word_, words_.data(), 4);
        words_ = words_.subspan(4);
        left_ = 8;
      }
      const std::uint32_t nibble = word_ >> 28;
      word_ <<= 4;
      --left_;
      value |= static_cast<std::int64_t>(nibble & 7) << shift;
      if ((nibble & 8) == 0) return value;
    }
    return -1;
  }

  Span words_;
  std::uint32_t word_ = 0;
  int left_ = 0;
};

void check_rvl(Span bytes, const Place& place) {
  if (bytes.size() < kDepthHeaderBytes) place.damaged("expected an RVL image, found its name only");
  std::array<std::uint32_t, 2> size;
  std::memcpy(size.data(), bytes.data() + kRvlMagic.size(), sizeof(size));
  const std::uint64_t pixels = std::uint64_t{size[0]} * size[1];
  const std::string shape = std::to_string(size[0]) + " x " + std::to_string(size[1]);
  if (pixels > kMostPixels) place.damaged("declares an RVL image of " + shape + " pixels");
  if (!RvlWalk(bytes.subspan(kDepthHeaderBytes)).covers(pixels)) {
    place.damaged("expected an RVL image of " + shape + " pixels, found fewer or others");
  }
}

bool check_if_png(Span bytes, const Place& place) {
  if (!text(bytes).starts_with(kPngMagic)) return false;
  check_png(bytes, place);
  return true;
}

bool check_if_rvl(Span bytes, const Place& place) {
  if (!text(bytes).starts_with(kRvlMagic)) return false;
  check_rvl(bytes, place);
  return true;
}

bool check_if_jpeg(Span bytes, const Place& place) {
  if (!text(bytes).starts_with(kJpegMagic)) return false;
  check_jpeg(bytes, place);
  return true;
}

}  // namespace

void check_image(Span bytes, const Place& place) {
  if (bytes.empty() || check_if_jpeg(bytes, place) || check_if_png(bytes, place)) return;
  place.damaged("expected a JPEG or PNG image, found " + std::to_string(bytes.size()) +
                " bytes of another kind");
}

void check_depth(Span bytes, const Place& place) {
  if (bytes.empty() || check_if_png(bytes, place) || check_if_rvl(bytes, place) ||
      check_if_jpeg(bytes, place)) {
    return;
  }
  if (text(bytes).starts_with(kInverseMagic) && bytes.size() > kDepthHeaderBytes) {
    const Span inner = bytes.subspan(kDepthHeaderBytes);
    if (check_if_png(inner, place) || check_if_rvl(inner, place)) return;
  }
  place.damaged("expected a depth image (PNG, RVL or JPEG), found " + std::to_string(bytes.size()) +
                " bytes of another kind");
}

}  // namespace zonepack::packer
