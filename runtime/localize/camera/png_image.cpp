// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "runtime/localize/camera/grey_rows.hpp"
#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/camera/image_refusal.hpp"

namespace zonepack::localize {
namespace {

constexpr png_alloc_size_t kMostChunkBytes = png_alloc_size_t{8} << 20;

// libpng reports an error by a call that must not return, so the decoder jumps out of it. Nothing
// between setjmp() and there has a destructor.
struct PngDecoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  ByteSpan left;
  std::jmp_buf out;
  char message[96] = {};
  const char* refused = nullptr;  // our own reason, not libpng's

  ~PngDecoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void refuse_png(PngDecoder& decoder, const char* why) {
  decoder.refused = why;
  std::longjmp(decoder.out, 1);
}

[[noreturn]] void on_png_error(png_structp png, png_const_charp message) {
  PngDecoder& decoder = *static_cast<PngDecoder*>(png_get_error_ptr(png));
  std::snprintf(decoder.message, sizeof decoder.message, "%s", message);
  std::longjmp(decoder.out, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

void give_png(png_structp png, png_bytep to, std::size_t count) {
  PngDecoder& decoder = *static_cast<PngDecoder*>(png_get_io_ptr(png));
  if (count > decoder.left.size()) refuse_png(decoder, "ends early");
  std::memcpy(to, decoder.left.data(), count);
  decoder.left = decoder.left.subspan(count);
}

// Reads up to the pixels, and has them delivered as 8-bit grey or RGB.
bool begin_png(PngDecoder& decoder) {
  if (setjmp(decoder.out) != 0) return false;
  png_structp png = decoder.png;
  png_set_read_fn(png, &decoder, give_png);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);  // check_image_size() judges them
  png_set_chunk_malloc_max(png, kMostChunkBytes);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // texts, profiles
  png_read_info(png, decoder.info);
  if (png_get_bit_depth(png, decoder.info) == 16) {
    refuse_png(decoder, "has 16 bits a channel, as depth images do");
  }
  png_set_expand(png);
  png_set_strip_alpha(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, decoder.info);
  return true;
}

bool decode_whole_png(PngDecoder& decoder, std::uint8_t* const* rows) {
  if (setjmp(decoder.out) != 0) return false;
  png_read_image(decoder.png, const_cast<png_bytepp>(rows));
  png_read_end(decoder.png, nullptr);
  return true;
}

bool decode_png_rows(PngDecoder& decoder, std::uint8_t* row, GreyImage& into) {
  if (setjmp(decoder.out) != 0) return false;
  const auto width = static_cast<std::size_t>(into.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(into.height); ++y) {
    png_read_row(decoder.png, row, nullptr);
    grey_of_rgb({row, 3 * width}, std::span(into.pixels).subspan(y * width, width));
  }
  png_read_end(decoder.png, nullptr);
  return true;
}

}  // namespace

Outcome<void> decode_png(ByteSpan bytes, const std::string& name, GreyImage& into) {
  PngDecoder decoder;
  decoder.left = bytes;
  decoder.png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, on_png_error, on_png_warning);
  if (decoder.png != nullptr) decoder.info = png_create_info_struct(decoder.png);
  if (decoder.info == nullptr) return failure(name + ": no memory to read it", ErrorCode::kIo);
  const auto refused = [&] {
    return decoder.refused != nullptr ? refused_image(name, "PNG", decoder.refused)
                                      : refused_image(name, "PNG", "is damaged", decoder.message);
  };
  if (!begin_png(decoder)) return refused();
  const std::uint32_t columns = png_get_image_width(decoder.png, decoder.info);
  const std::uint32_t lines = png_get_image_height(decoder.png, decoder.info);
  if (auto fits = check_image_size(name, columns, lines); !fits) return fits;
  const std::size_t width = columns, height = lines;
  const bool colour = png_get_channels(decoder.png, decoder.info) == 3;
  into.width = static_cast<int>(columns);
  into.height = static_cast<int>(lines);
  into.pixels.resize(width * height);
  if (colour && png_get_interlace_type(decoder.png, decoder.info) == PNG_INTERLACE_NONE) {
    std::vector<std::uint8_t> row(3 * width);
    return decode_png_rows(decoder, row.data(), into) ? Outcome<void>() : refused();
  }
  // An interlaced image is whole only at its end.
  std::vector<std::uint8_t> interlaced(colour ? 3 * width * height : 0);
  std::vector<std::uint8_t*> rows(height);
  for (std::size_t y = 0; y < height; ++y) {
    rows[y] = colour ? interlaced.data() + 3 * width * y : into.pixels.data() + width * y;
  }
  if (!decode_whole_png(decoder, rows.data())) return refused();
  if (colour) grey_of_rgb(interlaced, into.pixels);
  return {};
}

}  // namespace zonepack::localize
