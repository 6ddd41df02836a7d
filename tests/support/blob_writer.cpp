// SPDX-License-Identifier: Apache-2.0
#include "tests/support/blob_writer.hpp"

#include <zlib.h>

#include <array>
#include <cstring>
#include <stdexcept>

namespace zonepack::test_support {
namespace {

void append(Bytes& to, std::span<const std::byte> from) {
  const std::size_t old_size = to.size();
  to.resize(old_size + from.size());
  if (!from.empty()) std::memcpy(to.data() + old_size, from.data(), from.size());
}

template <typename T>
void append_value(Bytes& to, const T& value) {
  append(to, std::as_bytes(std::span<const T>(&value, 1)));
}

void append_text(Bytes& to, std::string_view text) {
  append(to, std::as_bytes(std::span<const char>(text.data(), text.size())));
}

void append_big_endian(Bytes& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::byte>(value >> shift));
}

Bytes zlib_stream(const Bytes& data) {
  uLongf size = compressBound(data.size());
  Bytes zipped(size);
  if (compress(reinterpret_cast<Bytef*>(zipped.data()), &size,
               reinterpret_cast<const Bytef*>(data.data()), data.size()) != Z_OK) {
    throw std::runtime_error("zlib refused to compress");
  }
  zipped.resize(size);
  return zipped;
}

void append_png_chunk(Bytes& to, std::string_view type, const Bytes& data) {
  append_big_endian(to, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = to.size();
  append_text(to, type);
  append(to, data);
  append_big_endian(
      to, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(to.data() + start),
                                           static_cast<uInt>(to.size() - start))));
}

class RvlWriter {
 public:
  void number(std::uint32_t value) {
    do {
      const std::uint32_t more = value > 7 ? 8 : 0;
      nibble((value & 7) | more);
      value >>= 3;
    } while (value != 0);
  }
  Bytes finish() {
    while (nibbles_ != 0) nibble(0);
    return std::move(out_);
  }

 private:
  void nibble(std::uint32_t value) {
    word_ = word_ << 4 | value;
    if (++nibbles_ == 8) {
      append_value(out_, word_);
      nibbles_ = 0;
    }
  }

  Bytes out_;
  std::uint32_t word_ = 0;
  int nibbles_ = 0;
};

}  // namespace

Bytes zip(const packer::Matrix& matrix) {
  Bytes blob = zlib_stream(matrix.data);
  for (const std::int32_t value : {matrix.rows, matrix.cols, matrix.type}) {
    append_value(blob, value);
  }
  return blob;
}

packer::Matrix float_matrix(std::int32_t rows, std::int32_t cols, std::int32_t channels,
                            const std::vector<float>& values) {
  return {rows, cols, float_type(channels), bytes_of(values)};
}

Bytes png(std::uint32_t width, std::uint32_t height, int bit_depth, int colour_type,
          const Bytes& pixels) {
  Bytes out;
  append_text(out, std::string_view("\x89PNG\r\n\x1a\n", 8));
  Bytes header;
  append_big_endian(header, width);
  append_big_endian(header, height);
  for (const int value : {bit_depth, colour_type, 0, 0, 0}) {
    header.push_back(static_cast<std::byte>(value));
  }
  append_png_chunk(out, "IHDR", header);
  const std::size_t row_bytes = pixels.size() / height;
  Bytes rows;
  for (std::size_t y = 0; y < height; ++y) {
    rows.push_back(std::byte{0});  // filter: none
    append(rows, std::span(pixels).subspan(y * row_bytes, row_bytes));
  }
  append_png_chunk(out, "IDAT", zlib_stream(rows));
  append_png_chunk(out, "IEND", {});
  return out;
}

Bytes jpeg(std::string_view comment) {
  static constexpr unsigned char kTables[] = {
      0xff, 0xdb, 0x00, 0x43, 0x00, 0x03, 0x02, 0x02, 0x02, 0x02, 0x02, 0x03, 0x02, 0x02, 0x02,
      0x03, 0x03, 0x03, 0x03, 0x04, 0x06, 0x04, 0x04, 0x04, 0x04, 0x04, 0x08, 0x06, 0x06, 0x05,
      0x06, 0x09, 0x08, 0x0a, 0x0a, 0x09, 0x08, 0x09, 0x09, 0x0a, 0x0c, 0x0f, 0x0c, 0x0a, 0x0b,
      0x0e, 0x0b, 0x09, 0x09, 0x0d, 0x11, 0x0d, 0x0e, 0x0f, 0x10, 0x10, 0x11, 0x10, 0x0a, 0x0c,
      0x12, 0x13, 0x12, 0x10, 0x13, 0x0f, 0x10, 0x10, 0x10, 0xff, 0xc9, 0x00, 0x0b, 0x08, 0x00,
      0x01, 0x00, 0x01, 0x01, 0x01, 0x11, 0x00, 0xff, 0xcc, 0x00, 0x06, 0x00, 0x10, 0x10, 0x05,
      0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0xd2, 0xcf, 0x20, 0xff, 0xd9};
  Bytes out;
  const auto length = static_cast<std::uint32_t>(comment.size() + 2);
  for (const std::uint32_t value : {0xffu, 0xd8u, 0xffu, 0xfeu, length >> 8, length & 0xffu}) {
    out.push_back(static_cast<std::byte>(value));
  }
  append_text(out, comment);
  append(out, std::as_bytes(std::span(kTables)));
  return out;
}

Bytes rvl(std::uint32_t width, std::uint32_t height, const std::vector<std::uint16_t>& depth_mm) {
  RvlWriter writer;
  std::int32_t previous = 0;
  for (std::size_t i = 0; i < depth_mm.size();) {
    std::size_t zeros = i;
    while (zeros < depth_mm.size() && depth_mm[zeros] == 0) ++zeros;
    std::size_t end = zeros;
    while (end < depth_mm.size() && depth_mm[end] != 0) ++end;
    writer.number(static_cast<std::uint32_t>(zeros - i));
    writer.number(static_cast<std::uint32_t>(end - zeros));
    for (i = zeros; i < end; ++i) {
      const std::int32_t delta = depth_mm[i] - previous;
      previous = depth_mm[i];
      const auto magnitude = static_cast<std::uint32_t>(delta < 0 ? -delta : delta);
      writer.number(delta < 0 ? magnitude * 2 - 1 : magnitude * 2);
    }
  }
  Bytes out;
  append_text(out, "DEPTHRVL");
  append_value(out, width);
  append_value(out, height);
  append(out, writer.finish());
  return out;
}

Bytes depth_png_16(std::uint32_t width, std::uint32_t height,
                   const std::vector<std::uint16_t>& depth_mm) {
  Bytes pixels;
  for (const std::uint16_t value : depth_mm) {
    pixels.push_back(static_cast<std::byte>(value >> 8));
    pixels.push_back(static_cast<std::byte>(value & 0xff));
  }
  return png(width, height, 16, 0, pixels);
}

Bytes depth_png_float(std::uint32_t width, std::uint32_t height,
                      const std::vector<float>& depth_m) {
  return png(width, height, 8, 6, bytes_of(depth_m));
}

Bytes mono_camera(std::int32_t width, std::int32_t height, double focal_px,
                  const packer::Transform& T_base_camera) {
  Bytes out;
  for (const std::int32_t value : {0, 23, 8, 0, width, height, 9, 5, 0, 12, 12}) {
    append_value(out, value);
  }
  const double cx = width / 2.0 - 0.5, cy = height / 2.0 - 0.5;
  const double values[26] = {focal_px, 0,        cx, 0,  focal_px, cy, 0,        0,  1, 0, 0, 0, 0,
                             0,        focal_px, 0,  cx, 0,        0,  focal_px, cy, 0, 0, 0, 1, 0};
  append(out, std::as_bytes(std::span(values)));
  append(out, std::as_bytes(std::span(T_base_camera)));
  return out;
}

Bytes stereo_camera(std::int32_t width, std::int32_t height, double focal_px, double baseline_m,
                    const packer::Transform& T_base_camera) {
  const Bytes side = mono_camera(width, height, focal_px, T_base_camera);
  const auto side_bytes = static_cast<std::int32_t>(side.size());
  Bytes out;
  for (const std::int32_t value : {0, 23, 8, 1, 9, 3, 9, 9, side_bytes, side_bytes}) {
    append_value(out, value);
  }
  std::array<double, 30> extrinsics{1, 0, 0, 0, 1, 0, 0, 0, 1, -baseline_m};
  append(out, std::as_bytes(std::span(extrinsics)));
  append(out, side);
  append(out, side);
  return out;
}

}  // namespace zonepack::test_support
