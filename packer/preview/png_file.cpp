// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/png_file.hpp"

#include <zlib.h>

#include <stdexcept>
#include <string_view>

#include "platform/base/require.hpp"

namespace zonepack::packer {
namespace {

// Big-endian, as in all of PNG.
void append_number(std::string& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xFF);
}

void append_chunk(std::string& file, std::string_view type, std::string_view content) {
  append_number(file, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = file.size();
  file.append(type).append(content);
  const auto* const data = reinterpret_cast<const Bytef*>(file.data() + begin);
  const uLong sum = ::crc32(0, data, static_cast<uInt>(file.size() - begin));
  append_number(file, static_cast<std::uint32_t>(sum));
}

std::string deflated(const std::string& bytes) {
  uLongf size = ::compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int code = ::compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  if (code != Z_OK) throw std::runtime_error("zlib cannot compress a picture");
  out.resize(size);
  return out;
}

// Each row begins with its filter (0: none); four pixels a byte, the first in the high bits.
std::string packed_rows(std::span<const std::uint8_t> pixels, std::size_t width) {
  std::string rows;
  for (std::size_t row = 0; row < pixels.size(); row += width) {
    rows += '\0';
    for (std::size_t x = 0; x < width; x += 4) {
      unsigned byte = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        byte = byte << 2 | (x + k < width ? pixels[row + x + k] & 3u : 0u);
      }
      rows += static_cast<char>(byte);
    }
  }
  return rows;
}

}  // namespace

std::string to_png(std::span<const std::uint8_t> pixels, std::size_t width,
                   const std::array<PngColor, 4>& palette) {
  ZP_REQUIRE(width > 0 && !pixels.empty() && pixels.size() % width == 0);
  std::string header;
  append_number(header, static_cast<std::uint32_t>(width));
  append_number(header, static_cast<std::uint32_t>(pixels.size() / width));
  header.append("\x02\x03\0\0\0", 5);  // two bits, indexed, the only compression and filter set
  std::string colors, opacities;
  for (const PngColor& color : palette) {
    for (const std::uint8_t part : {color.r, color.g, color.b}) colors += static_cast<char>(part);
    opacities += static_cast<char>(color.opacity);
  }
  std::string file = "\x89PNG\r\n\x1A\n";
  append_chunk(file, "IHDR", header);
  append_chunk(file, "PLTE", colors);
  append_chunk(file, "tRNS", opacities);
  append_chunk(file, "IDAT", deflated(packed_rows(pixels, width)));
  append_chunk(file, "IEND", "");
  return file;
}

}  // namespace zonepack::packer
