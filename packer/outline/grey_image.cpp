// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/grey_image.hpp"

#include <png.h>

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

std::string read_image_file(const std::string& path, std::size_t most_bytes) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  char buffer[65536];
  while (file.read(buffer, sizeof buffer) || file.gcount() > 0) {
    bytes.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > most_bytes) {
      refuse_image(path, "longer than the " + std::to_string(most_bytes) +
                             " bytes that an image may have here");
    }
  }
  if (file.bad() || (bytes.empty() && errno != 0)) {
    refuse_image(path, std::string("cannot read the image: ") + std::strerror(errno));
  }
  return bytes;
}

class PgmReader {
 public:
  PgmReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  GreyImage read(std::size_t most_pixels) {
    const bool text = bytes_[1] == '2';
    at_ = 2;
    GreyImage image;
    image.width = number("width");
    image.height = number("height");
    const std::size_t most = number("largest grey");
    if (at_ > kMostHeader) refuse_image(path_, "its header is longer than 4096 bytes");
    require_pixels(path_, image.width, image.height, most_pixels);
    if (most == 0 || most > 65535) {
      refuse_image(path_, "its largest grey is " + std::to_string(most) + ", expected 1 to 65535");
    }
    const std::size_t pixels = image.width * image.height;
    const std::size_t bytes_each = most > 255 ? 2 : 1;
    if (!text) {
      ++at_;  // the one blank after the header
      const std::size_t left = at_ < bytes_.size() ? bytes_.size() - at_ : 0;
      if (left / bytes_each < pixels) {
        refuse_image(path_, "ends early: " + pixels_text(image.width, image.height) +
                                " pixels need " + std::to_string(pixels * bytes_each) +
                                " bytes after the header, it has " + std::to_string(left));
      }
    } else if ((bytes_.size() - at_) / 2 + 1 < pixels) {
      refuse_image(path_, "ends early: it is too short for " +
                              pixels_text(image.width, image.height) + " numbers");
    }
    image.pixels.reserve(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      std::size_t grey = 0;
      if (text) {
        grey = number("pixel");
      } else {
        for (std::size_t k = 0; k < bytes_each; ++k) {
          grey = grey << 8 | static_cast<std::uint8_t>(bytes_[at_++]);
        }
      }
      if (grey > most) {
        refuse_image(path_, "pixel " + std::to_string(i) + " is " + std::to_string(grey) +
                                ", more than the largest grey of its header, " +
                                std::to_string(most));
      }
      image.pixels.push_back(static_cast<std::uint8_t>(grey * 255 / most));
    }
    return image;
  }

 private:
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
  std::string_view bytes_;
  std::size_t at_ = 0;
};

GreyImage read_png_image(const std::string& path, const std::string& bytes,
                         std::size_t most_pixels) {
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
  GreyImage image{png.width, png.height, {}, {}};
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

GreyImage read_grey_image(const std::string& path, std::size_t most_pixels) {
  // The longest form: numbers of five digits, each with a blank.
  const std::string bytes = read_image_file(path, kMostHeader + 6 * most_pixels);
  if (bytes.starts_with("P5") || bytes.starts_with("P2")) {
    return PgmReader(path, bytes).read(most_pixels);
  }
  if (bytes.starts_with("\x89PNG\r\n")) return read_png_image(path, bytes, most_pixels);
  refuse_image(path, bytes.empty()
                         ? "is empty; expected a PGM or PNG image"
                         : "is neither a PGM (P2, P5) nor a PNG image; convert it to one");
}

}  // namespace zonepack::packer
