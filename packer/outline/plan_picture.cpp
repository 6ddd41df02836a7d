// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/plan_picture.hpp"

#include <png.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace zonepack::packer {
namespace {

constexpr std::size_t kMostHeader = 4096;  // of a PGM, with its comments
constexpr std::size_t kMostText = 6;       // bytes of a pixel: five digits and a blank
// Of a PNG: where its width and height end, its longest pixel (four colours of 16 bits), and what
// else it may hold, such as texts and a profile of colours.
constexpr std::size_t kPngSizeEnds = 24, kMostPngPixel = 8, kMostPngExtra = std::size_t{4} << 20;

[[noreturn]] void refuse_image(const std::string& path, const std::string& why) {
  throw std::runtime_error(path + ": " + why);
}

std::string pixels_text(std::size_t width, std::size_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

void require_pixels(const std::string& path, std::size_t width, std::size_t height,
                    std::size_t most_pixels) {
  if (width == 0 || height == 0) refuse_image(path, "the image has no pixels");
  if (width > most_pixels / height) {
    refuse_image(path, "the image has " + pixels_text(width, height) + " pixels, at most " +
                           std::to_string(most_pixels) +
                           " are read; cut it, or save it at a coarser resolution");
  }
}

// A file that is read only as far as its first bytes say.
class ImageFile {
 public:
  explicit ImageFile(const std::string& path) : path_(path) {
    errno = 0;
    file_.open(path, std::ios::binary);
    read_to(kMostHeader);
  }

  // Reads on until `bytes()` has `size` bytes, or all that the file has.
  void read_to(std::size_t size) {
    char buffer[65536];
    while (bytes_.size() < size && file_.good()) {
      const std::size_t most = std::min(sizeof buffer, size - bytes_.size());
      file_.read(buffer, static_cast<std::streamsize>(most));
      bytes_.append(buffer, static_cast<std::size_t>(file_.gcount()));
    }
    if (file_.bad() || (bytes_.empty() && errno != 0)) {
      refuse_image(path_, std::string("cannot read the image: ") + std::strerror(errno));
    }
  }

  // Throws when the file has more than `most` bytes.
  void read_whole(std::size_t most) {
    read_to(most + 1);
    if (bytes_.size() <= most) return;
    refuse_image(path_, "longer than the " + std::to_string(most) +
                            " bytes that an image of its size may have; save it again");
  }

  const std::string& bytes() const { return bytes_; }

 private:
  const std::string& path_;
  std::ifstream file_;
  std::string bytes_;
};

class PgmReader {
 public:
  PgmReader(const std::string& path, ImageFile& file)
      : path_(path), file_(file), bytes_(file.bytes()), text_(bytes_[1] == '2') {}

  PlanPicture read(std::size_t most_pixels) {
    PlanPicture image = read_header(most_pixels);
    const std::size_t pixels = image.width * image.height;
    const std::size_t bytes_each = most_ > 255 ? 2 : 1;
    if (text_) {
      file_.read_whole(kMostHeader + kMostText * pixels);
      bytes_ = file_.bytes();
      if ((bytes_.size() - at_) / 2 + 1 < pixels) {
        refuse_image(path_, "ends early: it is too short for " +
                                pixels_text(image.width, image.height) + " numbers");
      }
    } else {
      ++at_;  // the one blank after the header
      file_.read_to(at_ + pixels * bytes_each);
      bytes_ = file_.bytes();
      const std::size_t left = at_ < bytes_.size() ? bytes_.size() - at_ : 0;
      if (left / bytes_each < pixels) {
        refuse_image(path_, "ends early: " + pixels_text(image.width, image.height) +
                                " pixels need " + std::to_string(pixels * bytes_each) +
                                " bytes after the header, it has " + std::to_string(left));
      }
    }
    image.pixels.reserve(pixels);
    for (std::size_t i = 0; i < pixels; ++i) image.pixels.push_back(pixel(i, bytes_each));
    return image;
  }

 private:
  PlanPicture read_header(std::size_t most_pixels) {
    PlanPicture image;
    image.width = number("width");
    image.height = number("height");
    most_ = number("largest grey");
    if (at_ >= kMostHeader) refuse_image(path_, "its header is longer than 4096 bytes");
    require_pixels(path_, image.width, image.height, most_pixels);
    if (most_ == 0 || most_ > 65535) {
      refuse_image(path_, "its largest grey is " + std::to_string(most_) + ", expected 1 to 65535");
    }
    return image;
  }

  std::uint8_t pixel(std::size_t i, std::size_t bytes_each) {
    std::size_t grey = 0;
    if (text_) {
      grey = number("pixel");
    } else {
      for (std::size_t k = 0; k < bytes_each; ++k) {
        grey = grey << 8 | static_cast<std::uint8_t>(bytes_[at_++]);
      }
    }
    if (grey > most_) {
      refuse_image(path_, "pixel " + std::to_string(i) + " is " + std::to_string(grey) +
                              ", more than the largest grey of its header, " +
                              std::to_string(most_));
    }
    return static_cast<std::uint8_t>(grey * 255 / most_);
  }

  std::size_t number(const char* what) {
    while (at_ < bytes_.size()) {
      const auto c = static_cast<unsigned char>(bytes_[at_]);
      if (c == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
      } else if (std::isspace(c) != 0) {
        ++at_;
      } else {
        break;
      }
    }
    const std::size_t from = at_;
    std::size_t value = 0;
    while (at_ < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[at_])) != 0) {
      value = value * 10 + static_cast<std::size_t>(bytes_[at_++] - '0');
      if (value > std::numeric_limits<std::uint32_t>::max() / 16) {
        refuse_image(path_, std::string("its ") + what + " is no number that fits");
      }
    }
    if (at_ == from) {
      refuse_image(path_, std::string("is no whole PGM file: expected its ") + what + " at byte " +
                              std::to_string(from));
    }
    return value;
  }

  const std::string& path_;
  ImageFile& file_;
  std::string_view bytes_;
  const bool text_;
  std::size_t most_ = 0, at_ = 2;
};

std::size_t big_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<std::uint8_t>(c);
  return value;
}

PlanPicture read_png_image(const std::string& path, ImageFile& file, std::size_t most_pixels) {
  if (file.bytes().size() < kPngSizeEnds || file.bytes().compare(12, 4, "IHDR") != 0) {
    refuse_image(path, "is no whole PNG file: it does not begin with its size");
  }
  const std::size_t width = big_endian(std::string_view(file.bytes()).substr(16, 4));
  const std::size_t height = big_endian(std::string_view(file.bytes()).substr(20, 4));
  require_pixels(path, width, height, most_pixels);
  file.read_whole(kMostPngExtra + kMostPngPixel * width * height);
  const std::string& bytes = file.bytes();
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> guard(&png, png_image_free);
  const auto check = [&](int done) {
    if (done == 0) refuse_image(path, std::string("is no whole PNG file: ") + png.message);
  };
  check(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()));
  require_pixels(path, png.width, png.height, most_pixels);
  const bool transparent = (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = PNG_FORMAT_RGBA;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  std::vector<std::uint8_t> colours(PNG_IMAGE_SIZE(png));
  check(png_image_finish_read(&png, nullptr, colours.data(), 0, nullptr));
  PlanPicture image{png.width, png.height, {}, {}};
  const std::size_t pixels = image.width * image.height;
  image.pixels.resize(pixels);
  if (transparent) image.opacity.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* const c = &colours[4 * i];
    image.pixels[i] = static_cast<std::uint8_t>((c[0] + c[1] + c[2]) / 3);
    if (transparent) image.opacity[i] = c[3];
  }
  return image;
}

}  // namespace

PlanPicture read_plan_picture(const std::string& path, std::size_t most_pixels) {
  ImageFile file(path);
  const std::string& bytes = file.bytes();
  if (bytes.starts_with("P5") || bytes.starts_with("P2")) {
    return PgmReader(path, file).read(most_pixels);
  }
  if (bytes.starts_with("\x89PNG\r\n")) return read_png_image(path, file, most_pixels);
  refuse_image(path, bytes.empty()
                         ? "is empty; expected a PGM or PNG image"
                         : "is neither a PGM (P2, P5) nor a PNG image; convert it to one");
}

}  // namespace zonepack::packer
