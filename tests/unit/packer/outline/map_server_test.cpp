// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/map_server.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "packer/preview/png_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

class GridFileTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& content) {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  GridFile read(const std::string& yaml) { return read_grid_file(write("map.yaml", yaml)); }
  std::string refusal(const std::string& yaml) {
    try {
      read(yaml);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  test_support::TemporaryFolder folder_;
  const std::string base_ = "image: map.pgm\nresolution: 0.5\norigin: [1, -2, 0.25]\n";
};

TEST_F(GridFileTest, ReadsWhiteAsFreeBlackAsOccupiedAndGreyAsUnknown) {
  // Upper row: 0, 205, 254; lower row: 255, 100, 60. Occupied is (255 - grey) / 255: 100 gives
  // 0.61, 205 gives 0.196, 60 gives 0.76.
  write("map.pgm", std::string("P5\n# made by hand\n3 2\n255\n") + '\x00' + '\xcd' + '\xfe' +
                       '\xff' + '\x64' + '\x3c');
  const GridFile map = read(base_ + "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(map.image.width, 3u);
  EXPECT_EQ(map.image.height, 2u);
  EXPECT_EQ(map.image.resolution_m, 0.5);
  EXPECT_EQ(map.image.x_min_m, 1);
  EXPECT_EQ(map.image.y_min_m, -2);
  EXPECT_EQ(map.yaw_rad, 0.25);
  EXPECT_EQ(map.image.cells, (std::vector<Cell>{Cell::kFree, Cell::kUnknown, Cell::kOccupied,
                                                Cell::kOccupied, Cell::kUnknown, Cell::kFree}));
}

TEST_F(GridFileTest, ReadsNumbersAsText) {
  write("map.pgm", "P2\n2 1\n15\n0 15\n");
  EXPECT_EQ(read(base_).image.cells, (std::vector<Cell>{Cell::kOccupied, Cell::kFree}));
}

TEST_F(GridFileTest, ReadsNegatedAndRawMaps) {
  write("map.pgm", std::string("P5 3 1 255\n") + '\x00' + '\x64' + '\xff');
  EXPECT_EQ(read(base_ + "negate: 1\n").image.cells,
            (std::vector<Cell>{Cell::kFree, Cell::kUnknown, Cell::kOccupied}));
  // Raw: 0 is free, 100 percent is occupied, 255 stands for -1.
  EXPECT_EQ(read(base_ + "mode: raw\n").image.cells,
            (std::vector<Cell>{Cell::kFree, Cell::kOccupied, Cell::kUnknown}));
}

TEST_F(GridFileTest, ReadsPngs) {
  // The palette: white, black.
  const std::vector<std::uint8_t> pixels{0, 1, 1, 0};
  write("map.png",
        to_png(pixels, 2,
               {PngColor{255, 255, 255, 255}, PngColor{0, 0, 0, 255}, PngColor{}, PngColor{}}));
  const GridFile map = read("image: map.png\nresolution: 0.05\norigin: [0, 0, 0]\n");
  EXPECT_EQ(map.image.cells,
            (std::vector<Cell>{Cell::kOccupied, Cell::kFree, Cell::kFree, Cell::kOccupied}));
}

TEST_F(GridFileTest, NamesTheKeyThatIsWrong) {
  write("map.pgm", "P2\n2 1\n15\n0 15\n");
  EXPECT_THAT(refusal("resolution: 0.05\norigin: [0, 0, 0]\n"),
              testing::HasSubstr("'image' is missing"));
  EXPECT_THAT(refusal("image: map.pgm\norigin: [0, 0, 0]\n"),
              testing::HasSubstr("'resolution' is missing"));
  EXPECT_THAT(refusal("image: map.pgm\nresolution: .nan\norigin: [0, 0, 0]\n"),
              testing::HasSubstr("'resolution' is '.nan', expected a number"));
  EXPECT_THAT(refusal("image: map.pgm\nresolution: 0\norigin: [0, 0, 0]\n"),
              testing::HasSubstr("expected 0.001 to 10 metres"));
  EXPECT_THAT(refusal("image: map.pgm\nresolution: 0.05\norigin: [0, 0]\n"),
              testing::HasSubstr("'origin' must be [x, y, yaw]"));
  EXPECT_THAT(refusal(base_ + "mode: fuzzy\n"),
              testing::HasSubstr("expected trinary, scale or raw"));
  EXPECT_THAT(refusal(base_ + "free_thresh: 0.9\n"), testing::HasSubstr("'free_thresh'"));
  EXPECT_THAT(refusal(base_ + "negate: maybe\n"), testing::HasSubstr("expected 0 or 1"));
  EXPECT_THAT(refusal("- a\n"), testing::HasSubstr("is no list of keys"));
  EXPECT_THAT(refusal("a: [\n"), testing::HasSubstr("line "));
  EXPECT_THAT(refusal(std::string(70000, 'a')), testing::HasSubstr("longer than 65536 bytes"));
}

TEST_F(GridFileTest, NamesTheImageThatIsWrong) {
  EXPECT_THAT(refusal(base_), testing::HasSubstr("map.pgm: cannot read the image"));
  write("map.pgm", "");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("is empty"));
  write("map.pgm", "GIF89a");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("neither a PGM"));
  write("map.pgm", "P5\n3 2\n255\nab");
  EXPECT_THAT(refusal(base_),
              testing::HasSubstr("3 x 2 pixels need 6 bytes after the header, it has 2"));
  write("map.pgm", "P5\n4000000000 2\n255\n");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("its width is no number that fits"));
  write("map.pgm", "P5\n100000 100000\n255\n");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("at most 67108864 are read"));
  write("map.pgm", "P5\n# " + std::string(5000, 'a') + "\n3 2\n255\n123456");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("expected its width at byte 4096"));
  write("map.pgm", "P5\n0 2\n255\n");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("has no pixels"));
  write("map.pgm", "P2\n2 1\n15\n0 16\n");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("pixel 1 is 16"));
  write("map.pgm", "P5\n2 x");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("expected its height at byte 5"));
  write("map.pgm", "\x89PNG\r\n\x1a\n and then nothing");
  EXPECT_THAT(refusal(base_), testing::HasSubstr("is no whole PNG file"));
  // Its first bytes say 30,000 x 30,000, which nothing follows.
  write("map.pgm", std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x75\x30\0\0\x75\x30", 24));
  EXPECT_THAT(refusal(base_), testing::HasSubstr("30000 x 30000 pixels, at most 67108864"));
}

TEST_F(GridFileTest, ReadsNothingBehindAHeaderThatClaimsTooMuch) {
  // 900 MB, all of it a hole of the file.
  const std::string path = write("map.pgm", "P5\n30000 30000\n255\n");
  std::filesystem::resize_file(path, 900'000'000);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_THAT(refusal(base_), testing::HasSubstr("30000 x 30000 pixels, at most 67108864"));
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 4096);  // KiB
}

TEST_F(GridFileTest, ReadsLongNumbersAndWhatFollowsThem) {
  write("map.pgm", "P2\n2 2\n65535\n65535 65535\n00000 00000\n\n");
  EXPECT_EQ(read(base_).image.cells,
            (std::vector<Cell>{Cell::kOccupied, Cell::kOccupied, Cell::kFree, Cell::kFree}));
}

}  // namespace
}  // namespace zonepack::packer
