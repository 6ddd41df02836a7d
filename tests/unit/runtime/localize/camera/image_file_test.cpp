// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include "runtime/localize/camera/grey_rows.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/localize/made_images.hpp"

namespace zonepack::localize {
namespace {

using testing::AllOf;
using testing::HasSubstr;

GreyImage decoded(const Bytes& bytes) {
  auto image = decode_image(bytes, "image");
  EXPECT_TRUE(image) << image.error().message;
  return image ? std::move(image).value() : GreyImage{};
}

std::string refusal(const Bytes& bytes) {
  const auto image = decode_image(bytes, "cam.jpg");
  EXPECT_FALSE(image);
  return image ? "" : image.error().message;
}

void write(const std::string& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// 8 x + 4 y, to the 2 grey levels that quality 95 loses.
void expect_ramp(const GreyImage& image, int tolerance) {
  ASSERT_EQ(image.width, 16);
  ASSERT_EQ(image.height, 8);
  ASSERT_TRUE(image.whole());
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const int value = image.pixels[static_cast<std::size_t>(16 * y + x)];
      EXPECT_LE(std::abs(value - (8 * x + 4 * y)), tolerance) << x << ' ' << y;
    }
  }
}

TEST(ReadImage, ReadsAGreyJpeg) { expect_ramp(decoded(make_jpeg()), 2); }

TEST(ReadImage, ReadsAProgressiveJpeg) {
  MadeJpeg made;
  made.progressive = true;
  expect_ramp(decoded(make_jpeg(made)), 2);
}

TEST(ReadImage, TakesTheLumaOfAColourJpeg) {
  MadeJpeg made;
  made.space = JCS_RGB;
  made.channels = 3;
  // Red 200, green 100, blue 50: 59.8 + 58.7 + 5.7 = 124.2.
  made.value = [](int, int, int channel) { return channel == 0 ? 200 : channel == 1 ? 100 : 50; };
  const GreyImage image = decoded(make_jpeg(made));
  for (const std::uint8_t value : image.pixels) EXPECT_LE(std::abs(value - 124), 1);
}

TEST(ReadImage, RefusesCmykByName) {
  MadeJpeg made;
  made.space = JCS_CMYK;
  made.channels = 4;
  EXPECT_THAT(refusal(make_jpeg(made)), AllOf(HasSubstr("cam.jpg: is a JPEG that is in CMYK"),
                                              HasSubstr("expected a JPEG or a PNG")));
}

// The last row of a file that was cut is missing, wherever it was cut.
TEST(ReadImage, RefusesAJpegThatEndsEarlyWhereverItWasCut) {
  const Bytes whole = make_jpeg();
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode_image(cut, "cam.jpg")) << size << " of " << whole.size();
  }
  const Bytes half(whole.begin(), whole.end() - 20);
  EXPECT_THAT(refusal(half), HasSubstr("JPEG that ends early"));
}

TEST(ReadImage, RefusesAPngThatEndsEarlyWhereverItWasCut) {
  const Bytes whole = make_png();
  for (std::size_t size = 0; size + 4 < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode_image(cut, "cam.png")) << size << " of " << whole.size();
  }
  EXPECT_THAT(refusal(Bytes(whole.begin(), whole.end() - 20)), HasSubstr("PNG that ends early"));
}

TEST(ReadImage, ReadsAGreyPngExactly) { expect_ramp(decoded(make_png()), 0); }

TEST(ReadImage, ReadsAnInterlacedPng) {
  MadePng made;
  made.interlace = PNG_INTERLACE_ADAM7;
  expect_ramp(decoded(make_png(made)), 0);
}

// (200 * 4899 + 100 * 9617 + 50 * 1868 + 8192) >> 14 = 2,043,092 >> 14 = 124.
TEST(ReadImage, WeighsTheColoursOfAPng) {
  MadePng made;
  made.type = PNG_COLOR_TYPE_RGB;
  made.channels = 3;
  made.value = [](int, int, int channel) { return channel == 0 ? 200 : channel == 1 ? 100 : 50; };
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    made.interlace = interlace;
    EXPECT_THAT(decoded(make_png(made)).pixels, testing::Each(124));
  }
}

TEST(ReadImage, LeavesTransparencyAside) {
  MadePng made;
  made.type = PNG_COLOR_TYPE_RGB_ALPHA;
  made.channels = 4;
  made.value = [](int, int, int channel) { return channel == 3 ? 0 : 77; };
  EXPECT_THAT(decoded(make_png(made)).pixels, testing::Each(77));
}

// Red 255: 255 * 4899 >> 14 = 76; blue 255: 255 * 1868 >> 14 = 29.
TEST(ReadImage, LooksColoursUpInAPalette) {
  MadePng made;
  made.type = PNG_COLOR_TYPE_PALETTE;
  made.value = [](int x, int, int) { return x % 2; };
  const GreyImage image = decoded(make_png(made));
  EXPECT_EQ(image.pixels[0], 76);
  EXPECT_EQ(image.pixels[1], 29);
}

TEST(ReadImage, RefusesSixteenBitsByName) {
  MadePng made;
  made.depth = 16;
  EXPECT_THAT(refusal(make_png(made)), HasSubstr("PNG that has 16 bits a channel"));
}

// A header of 33 bytes that promises 4 G pixels.
TEST(ReadImage, ChecksThePngsSizeBeforeItTakesMemory) {
  MadePng made;
  made.width = 4097;
  made.height = 1;
  EXPECT_THAT(refusal(make_png(made)), HasSubstr("is 4097x1 pixels; expected 1 to 4096 a side"));
}

TEST(ReadImage, ChecksTheJpegsSizeBeforeItTakesMemory) {
  Bytes bytes = make_jpeg();
  // The frame header: FF C0, length, 8 bits, then height and width.
  const Bytes marker = {std::byte{0xFF}, std::byte{0xC0}};
  const auto at = std::search(bytes.begin(), bytes.end(), marker.begin(), marker.end());
  ASSERT_NE(at, bytes.end());
  *(at + 5) = std::byte{0xFF};
  *(at + 7) = std::byte{0xFF};
  EXPECT_THAT(refusal(bytes), HasSubstr("pixels; expected 1 to 4096 a side"));
}

TEST(ReadImage, NamesOtherKindsOfFile) {
  const auto bytes = [](std::string_view text) {
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    return Bytes(begin, begin + text.size());
  };
  EXPECT_THAT(refusal({}), HasSubstr("is empty (0 bytes)"));
  EXPECT_THAT(refusal(bytes("GIF89a")), HasSubstr("is a GIF"));
  EXPECT_THAT(refusal(bytes("hello")), HasSubstr("no image of a known kind"));
}

TEST(ReadImage, SaysThatAFileIsMissing) {
  const auto image = read_image("/nonexistent/cam.jpg");
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().message, HasSubstr("/nonexistent/cam.jpg: is not there"));
}

TEST(ReadImage, ReadsAFile) {
  const test_support::TemporaryFolder folder;
  const std::string file = (folder.path() / "a.png").string();
  write(file, make_png());
  const auto image = read_image(file);
  ASSERT_TRUE(image) << image.error().message;
  expect_ramp(*image, 0);
}

// Whatever a single wrong byte does, it ends in an image of a checked size or a named refusal.
TEST(ReadImage, SurvivesAnyWrongByte) {
  std::mt19937 random(7);
  MadeJpeg progressive;
  progressive.progressive = true;
  MadePng colour;
  colour.type = PNG_COLOR_TYPE_RGB;
  colour.channels = 3;
  for (const Bytes& whole : {make_jpeg(), make_jpeg(progressive), make_png(), make_png(colour)}) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      Bytes damaged = whole;
      damaged[i] ^= static_cast<std::byte>(1 + random() % 255);
      const auto image = decode_image(damaged, "cam");
      if (image) {
        EXPECT_TRUE(image->whole()) << i;
      } else {
        EXPECT_THAT(image.error().message, HasSubstr("cam: ")) << i;
      }
    }
  }
}

// 2 pixels of Y U Y V: 10 and 20 are grey.
TEST(GreyRows, TakeEverySecondByteOfYuyv) {
  const std::vector<std::uint8_t> from = {10, 1, 20, 2};
  std::vector<std::uint8_t> to(2);
  grey_of_yuyv(from, to);
  EXPECT_THAT(to, testing::ElementsAre(10, 20));
}

// Pure red 255 weighs 76, blue 29; BGR has them the other way round.
TEST(GreyRows, KnowRedFromBlue) {
  const std::vector<std::uint8_t> from = {255, 0, 0};
  std::vector<std::uint8_t> rgb(1), bgr(1);
  grey_of_rgb(from, rgb);
  grey_of_bgr(from, bgr);
  EXPECT_EQ(rgb[0], 76);
  EXPECT_EQ(bgr[0], 29);
}

}  // namespace
}  // namespace zonepack::localize
