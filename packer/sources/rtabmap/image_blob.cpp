// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/image_blob.hpp"

#include <string>
#include <string_view>

namespace zonepack::packer {
namespace {

constexpr std::string_view kPng("\x89PNG\r\n\x1a\n", 8);
constexpr std::string_view kJpeg("\xff\xd8\xff", 3);
constexpr std::string_view kRvl = "DEPTHRVL";
constexpr std::string_view kInverse = "DEPTHINV";
constexpr std::size_t kDepthHeaderBytes = 16;  // name, then two numbers of 4 bytes

std::string_view text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_depth(std::string_view bytes) {
  return bytes.starts_with(kPng) || (bytes.starts_with(kRvl) && bytes.size() >= kDepthHeaderBytes);
}

bool is_inverse_depth(std::string_view bytes) {
  return bytes.starts_with(kInverse) && bytes.size() >= kDepthHeaderBytes &&
         is_depth(bytes.substr(kDepthHeaderBytes));
}

}  // namespace

void check_image(std::span<const std::byte> bytes, const CellPlace& place) {
  const std::string_view image = text(bytes);
  if (image.empty() || image.starts_with(kJpeg) || image.starts_with(kPng)) return;
  place.damaged("expected a JPEG or PNG image, found " + std::to_string(bytes.size()) +
                " bytes of another kind");
}

void check_depth(std::span<const std::byte> bytes, const CellPlace& place) {
  const std::string_view image = text(bytes);
  if (image.empty() || is_depth(image) || image.starts_with(kJpeg) || is_inverse_depth(image)) {
    return;
  }
  place.damaged("expected a depth image (PNG, RVL or JPEG), found " + std::to_string(bytes.size()) +
                " bytes of another kind");
}

}  // namespace zonepack::packer
