// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

// jpeglib.h uses what <cstdio> declares.
#include <jpeglib.h>
#include <png.h>

// Small images written by libjpeg and libpng, for tests of what reads them.
namespace zonepack::localize {

using Bytes = std::vector<std::byte>;

struct MadeJpeg {
  int width = 16, height = 8;
  J_COLOR_SPACE space = JCS_GRAYSCALE;
  int channels = 1;
  bool progressive = false;
  // value(x, y, channel)
  int (*value)(int, int, int) = [](int x, int y, int) { return 8 * x + 4 * y; };
};

inline Bytes make_jpeg(const MadeJpeg& made = {}) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  jpeg.image_width = static_cast<JDIMENSION>(made.width);
  jpeg.image_height = static_cast<JDIMENSION>(made.height);
  jpeg.input_components = made.channels;
  jpeg.in_color_space = made.space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (made.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<unsigned char> row(static_cast<std::size_t>(made.width * made.channels));
  for (int y = 0; y < made.height; ++y) {
    for (int i = 0; i < made.width * made.channels; ++i) {
      row[static_cast<std::size_t>(i)] =
          static_cast<unsigned char>(made.value(i / made.channels, y, i % made.channels));
    }
    unsigned char* line = row.data();
    jpeg_write_scanlines(&jpeg, &line, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const auto* const begin = reinterpret_cast<const std::byte*>(out);
  const Bytes bytes(begin, begin + size);
  std::free(out);
  return bytes;
}

struct MadePng {
  int width = 16, height = 8;
  int type = PNG_COLOR_TYPE_GRAY;
  int channels = 1;
  int depth = 8;
  int interlace = PNG_INTERLACE_NONE;
  int (*value)(int, int, int) = [](int x, int y, int) { return 8 * x + 4 * y; };
};

inline Bytes make_png(const MadePng& made = {}) {
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto write = [](png_structp to, png_bytep data, std::size_t count) {
    auto& all = *static_cast<Bytes*>(png_get_io_ptr(to));
    const auto* const begin = reinterpret_cast<const std::byte*>(data);
    all.insert(all.end(), begin, begin + count);
  };
  png_set_write_fn(png, &bytes, write, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(made.width),
               static_cast<png_uint_32>(made.height), made.depth, made.type, made.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (made.type == PNG_COLOR_TYPE_PALETTE) {
    const png_color colours[2] = {{255, 0, 0}, {0, 0, 255}};
    png_set_PLTE(png, info, colours, 2);
  }
  png_write_info(png, info);
  const int sample_bytes = made.depth == 16 ? 2 : 1;
  const auto width = static_cast<std::size_t>(made.width * made.channels * sample_bytes);
  std::vector<std::vector<unsigned char>> rows(static_cast<std::size_t>(made.height));
  std::vector<png_bytep> lines;
  for (int y = 0; y < made.height; ++y) {
    auto& row = rows[static_cast<std::size_t>(y)];
    row.resize(width);
    for (std::size_t i = 0; i < width; ++i) {
      const int sample = static_cast<int>(i) / sample_bytes;
      row[i] =
          static_cast<unsigned char>(made.value(sample / made.channels, y, sample % made.channels));
    }
    lines.push_back(row.data());
  }
  png_write_image(png, lines.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace zonepack::localize
