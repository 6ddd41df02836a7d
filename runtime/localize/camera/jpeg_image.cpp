// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstdio>

// jpeglib.h uses what <cstdio> declares.
#include <jerror.h>
#include <jpeglib.h>

#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/camera/image_refusal.hpp"

namespace zonepack::localize {
namespace {

// Real cameras write at most 10; each costs a pass over the whole image.
constexpr int kMostScans = 64;

// libjpeg reports an error by a call that must not return, so the decoder jumps out of it. Nothing
// between setjmp() and there has a destructor.
struct JpegDecoder {
  jpeg_decompress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg_progress_mgr progress;
  std::jmp_buf out;
  char message[JMSG_LENGTH_MAX];
  const char* refused;  // our own reason, not libjpeg's
};

JpegDecoder& jpeg_decoder_of(j_common_ptr jpeg) {
  return *static_cast<JpegDecoder*>(jpeg->client_data);
}

[[noreturn]] void refuse_jpeg(JpegDecoder& decoder, const char* why) {
  decoder.refused = why;
  std::longjmp(decoder.out, 1);
}

[[noreturn]] void on_jpeg_error(j_common_ptr jpeg) {
  JpegDecoder& decoder = jpeg_decoder_of(jpeg);
  (*jpeg->err->format_message)(jpeg, decoder.message);
  std::longjmp(decoder.out, 1);
}

// libjpeg fills what is missing with grey and only warns. Bytes between two markers do no harm;
// some webcams pad their frames with them.
void on_jpeg_message(j_common_ptr jpeg, int level) {
  if (level >= 0 || jpeg->err->msg_code == JWRN_EXTRANEOUS_DATA) return;
  if (jpeg->err->msg_code == JWRN_JPEG_EOF) refuse_jpeg(jpeg_decoder_of(jpeg), "ends early");
  on_jpeg_error(jpeg);
}

void on_jpeg_progress(j_common_ptr jpeg) {
  JpegDecoder& decoder = jpeg_decoder_of(jpeg);
  if (decoder.jpeg.input_scan_number > kMostScans) refuse_jpeg(decoder, "has more than 64 scans");
}

bool begin_jpeg(JpegDecoder& decoder, ByteSpan bytes) {
  if (setjmp(decoder.out) != 0) return false;
  jpeg_create_decompress(&decoder.jpeg);
  decoder.jpeg.client_data = &decoder;
  decoder.jpeg.progress = &decoder.progress;
  decoder.jpeg.mem->max_memory_to_use = static_cast<long>(kMostDecoderBytes);
  jpeg_mem_src(&decoder.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()),
               static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&decoder.jpeg, TRUE);
  const J_COLOR_SPACE space = decoder.jpeg.jpeg_color_space;
  if (space == JCS_CMYK || space == JCS_YCCK)
    refuse_jpeg(decoder, "is in CMYK, a printer's colours");
  decoder.jpeg.out_color_space = JCS_GRAYSCALE;
  decoder.jpeg.dct_method = JDCT_ISLOW;  // the same bits on every computer
  return true;
}

bool decode_scans(JpegDecoder& decoder, std::uint8_t* to) {
  if (setjmp(decoder.out) != 0) return false;
  jpeg_start_decompress(&decoder.jpeg);
  while (decoder.jpeg.output_scanline < decoder.jpeg.output_height) {
    std::uint8_t* row = to + std::size_t{decoder.jpeg.output_scanline} * decoder.jpeg.output_width;
    jpeg_read_scanlines(&decoder.jpeg, &row, 1);
  }
  jpeg_finish_decompress(&decoder.jpeg);
  return true;
}

}  // namespace

Outcome<void> decode_jpeg(ByteSpan bytes, const std::string& name, GreyImage& into) {
  JpegDecoder decoder{};
  decoder.jpeg.err = jpeg_std_error(&decoder.errors);
  decoder.errors.error_exit = on_jpeg_error;
  decoder.errors.emit_message = on_jpeg_message;
  decoder.progress.progress_monitor = on_jpeg_progress;
  struct End {
    jpeg_decompress_struct& jpeg;
    ~End() { jpeg_destroy_decompress(&jpeg); }
  } const end{decoder.jpeg};
  // Before jpeg_create_decompress() clears it, an error needs to find the decoder as well.
  decoder.jpeg.client_data = &decoder;
  const auto refused = [&] {
    return decoder.refused != nullptr ? refused_image(name, "JPEG", decoder.refused)
                                      : refused_image(name, "JPEG", "is damaged", decoder.message);
  };
  if (!begin_jpeg(decoder, bytes)) return refused();
  if (auto fits = check_image_size(name, decoder.jpeg.image_width, decoder.jpeg.image_height);
      !fits) {
    return fits;
  }
  into.width = static_cast<int>(decoder.jpeg.image_width);
  into.height = static_cast<int>(decoder.jpeg.image_height);
  into.pixels.resize(std::size_t{decoder.jpeg.image_width} * decoder.jpeg.image_height);
  if (!decode_scans(decoder, into.pixels.data())) return refused();
  return {};
}

}  // namespace zonepack::localize
