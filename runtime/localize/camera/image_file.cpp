// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_file.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "platform/base/file_kind.hpp"
#include "platform/files/storage.hpp"
#include "runtime/localize/camera/image_refusal.hpp"

namespace zonepack::localize {
namespace {

constexpr std::string_view kExpectedImage = "expected a JPEG or a PNG of 8 bits a channel";

bool begins_with(ByteSpan bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(), [](char a, std::byte b) {
           return static_cast<unsigned char>(a) == std::to_integer<unsigned char>(b);
         });
}

// Kinds of image that people have and this program does not read.
std::string other_kind(ByteSpan bytes, const std::string& name) {
  using namespace std::string_view_literals;
  struct Kind {
    std::string_view magic, word;
  };
  static constexpr std::array kKinds{
      Kind{"GIF8"sv, "a GIF"},   Kind{"BM"sv, "a BMP"},           Kind{"II*\0"sv, "a TIFF"},
      Kind{"MM\0*"sv, "a TIFF"}, Kind{"RIFF"sv, "a WebP or AVI"}, Kind{"P5"sv, "a PGM"},
      Kind{"P6"sv, "a PPM"},
  };
  for (const Kind& kind : kKinds) {
    if (begins_with(bytes, kind.magic)) return std::string(kind.word);
  }
  const auto first = bytes.first(std::min(bytes.size(), kFileKindBytes));
  return known_kind({reinterpret_cast<const char*>(first.data()), first.size()}, name);
}

}  // namespace

Failure refused_image(const std::string& name, std::string_view kind, std::string_view what,
                      std::string_view detail) {
  std::string text = name + ": is a " + std::string(kind) + " that " + std::string(what);
  if (!detail.empty()) text += " (" + std::string(detail) + ")";
  return failure(text + "; " + std::string(kExpectedImage));
}

Outcome<void> check_image_size(const std::string& name, std::uint64_t width, std::uint64_t height) {
  constexpr auto kMost = static_cast<std::uint64_t>(kMostImageSide_px);
  if (width > 0 && height > 0 && width <= kMost && height <= kMost) return {};
  return failure(name + ": is " + std::to_string(width) + "x" + std::to_string(height) +
                     " pixels; expected 1 to " + std::to_string(kMost) + " a side",
                 ErrorCode::kTooLarge);
}

Outcome<GreyImage> decode_image(ByteSpan bytes, const std::string& name) {
  GreyImage image;
  Outcome<void> decoded;
  if (begins_with(bytes, "\xFF\xD8\xFF")) {
    decoded = decode_jpeg(bytes, name, image);
  } else if (begins_with(bytes, "\x89PNG\r\n\x1A\n")) {
    decoded = decode_png(bytes, name, image);
  } else if (bytes.empty()) {
    decoded = failure(name + ": is empty (0 bytes); " + std::string(kExpectedImage));
  } else {
    const std::string kind = other_kind(bytes, name);
    decoded = failure(name + ": is " + (kind.empty() ? "no image of a known kind" : kind) + "; " +
                      std::string(kExpectedImage));
  }
  if (!decoded) return decoded.error();
  return image;
}

Outcome<GreyImage> read_image(const std::string& file) {
  const auto bytes = read_file(file, kMostImageBytes);
  if (bytes) return decode_image(*bytes, file);
  if (bytes.error().code == ErrorCode::kTooLarge) {
    return failure(file + ": has more than " + std::to_string(kMostImageBytes >> 20) + " MiB; " +
                       std::string(kExpectedImage),
                   ErrorCode::kTooLarge);
  }
  if (bytes.error().code == ErrorCode::kNotFound) {
    return failure(file + ": is not there; " + std::string(kExpectedImage), ErrorCode::kNotFound);
  }
  return failure(file + ": cannot be read: " + reason_text(bytes.error()), ErrorCode::kIo);
}

}  // namespace zonepack::localize
