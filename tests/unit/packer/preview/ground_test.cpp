// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "packer/build/map_builder.hpp"
#include "packer/outline/plan_picture.hpp"
#include "packer/preview/png_file.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

TEST(PngFile, HoldsASignatureItsSizeAndItsColours) {
  const std::string png = to_png(std::vector<std::uint8_t>{0, 1, 2, 0, 1, 2}, 3,
                                 {PngColor{9, 8, 7, 6}, PngColor{}, PngColor{}, PngColor{}});
  EXPECT_TRUE(png.starts_with("\x89PNG\r\n\x1A\n"));
  // IHDR: length 13; 3 x 2 pixels of two bits, indexed.
  EXPECT_EQ(png.substr(8, 8), std::string("\0\0\0\rIHDR", 8));
  EXPECT_EQ(png.substr(16, 10), std::string("\0\0\0\3\0\0\0\2\2\3", 10));
  EXPECT_NE(png.find("PLTE\x09\x08\x07"), png.npos);
  EXPECT_NE(png.find("tRNS\x06\xFF\xFF\xFF"), png.npos);
  // The CRC of an empty IEND is known from the standard.
  EXPECT_TRUE(png.ends_with("IEND\xAE\x42\x60\x82"));
}

MapImage image(std::size_t width, std::size_t height) {
  MapImage grid;
  grid.width = width;
  grid.height = height;
  grid.resolution_m = 0.05;
  grid.x_min_m = -1;
  grid.y_min_m = 2;
  grid.cells.assign(width * height, Cell::kFree);
  return grid;
}

TEST(Raster, CoversTheCellsOfTheGrid) {
  const auto raster = raster_of(image(40, 20));
  ASSERT_TRUE(raster);
  EXPECT_DOUBLE_EQ(raster->area.min.x_m, -1);
  EXPECT_DOUBLE_EQ(raster->area.min.y_m, 2);
  EXPECT_DOUBLE_EQ(raster->area.max.x_m, 1);  // 40 cells of 5 cm
  EXPECT_DOUBLE_EQ(raster->area.max.y_m, 3);
  EXPECT_FALSE(raster_of(MapImage{}));
}

TEST(Raster, MergesCellsUntilTheyAreFewEnough) {
  // 41 x 20 in at most 205: cells of 2 x 2 give 21 x 10 = 210, of 3 x 3 14 x 7 = 98.
  const auto raster = raster_of(image(41, 20), 205);
  ASSERT_TRUE(raster);
  EXPECT_EQ(raster->png.substr(16, 8), std::string("\0\0\0\x0E\0\0\0\x07", 8));
  EXPECT_DOUBLE_EQ(raster->area.max.x_m, -1 + 14 * 0.15);
}

TEST(Raster, KeepsAWallOfOneCell) {
  MapImage walled = image(40, 20);
  const std::string without = raster_of(walled, 50)->png;
  walled.cells[7 * 40 + 13] = Cell::kOccupied;
  EXPECT_NE(raster_of(walled, 50)->png, without);
}

TEST(Raster, TurnsAGridWithItsYaw) {
  MapDrawing drawing;
  drawing.image = image(40, 20);
  drawing.yaw_rad = std::acos(-1.0) / 2;
  // A quarter turn: u along the grid goes up, v to the left; from (-1, 2) to (-2, 4).
  MapImage upright = image(20, 40);
  upright.x_min_m = -2;
  for (const auto& [u, v] : {std::pair{3u, 5u}, {4u, 5u}, {39u, 0u}}) {
    drawing.image.cells[v * 40 + u] = Cell::kOccupied;
    upright.cells[u * 20 + 19 - v] = Cell::kOccupied;
  }
  const auto raster = raster_of(drawing);
  ASSERT_TRUE(raster);
  EXPECT_EQ(raster->png, raster_of(upright)->png);
  EXPECT_NEAR(raster->area.min.x_m, -2, 1e-9);
  EXPECT_NEAR(raster->area.max.x_m, -1, 1e-9);
  EXPECT_NEAR(raster->area.min.y_m, 2, 1e-9);
  EXPECT_NEAR(raster->area.max.y_m, 4, 1e-9);
}

TEST(Raster, ShowsATurnedCellWhereItStands) {
  MapDrawing drawing;
  drawing.image = image(40, 20);
  drawing.yaw_rad = 0.6;
  drawing.image.cells[8 * 40 + 30] = Cell::kOccupied;
  const auto raster = raster_of(drawing);
  const test_support::TemporaryFolder folder;
  const std::string file = (folder.path() / "raster.png").string();
  std::ofstream(file, std::ios::binary) << raster->png;
  const PlanPicture grey = read_plan_picture(file, 10'000);
  // Its middle is 30.5 and 8.5 cells of 5 cm along the grid's sides from (-1, 2).
  const double x = -1 + std::cos(0.6) * 1.525 - std::sin(0.6) * 0.425;
  const double y = 2 + std::sin(0.6) * 1.525 + std::cos(0.6) * 0.425;
  std::size_t dark = 0;
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    if (grey.opacity[i] < 200) continue;  // free or not seen
    ++dark;
    EXPECT_NEAR(raster->area.min.x_m + (static_cast<double>(i % grey.width) + 0.5) * 0.05, x, 0.06);
    EXPECT_NEAR(raster->area.max.y_m - (static_cast<double>(i / grey.width) + 0.5) * 0.05, y, 0.06);
  }
  EXPECT_GE(dark, 1u);
  EXPECT_LE(dark, 5u);
}

std::string build_map(const fs::path& out, PayloadMask payload) {
  BuildOptions options;
  options.source = fs::path(ZONEPACK_TEST_DATA) / "hospital-small.db";
  options.zones = fs::path(ZONEPACK_TEST_DATA) / "zones.geojson";
  options.out = out;
  options.payload = payload;
  std::ostringstream quiet;
  Progress progress(quiet, false);
  packer::build_map(options, progress);
  return out.string();
}

TEST(GroundOfAMap, IsThatOfItsDatabase) {
  const test_support::TemporaryFolder folder;
  const MapDrawing packed =
      drawing_of(MapReader(build_map(folder / "map", kCoreOnly | mask_of(fb::PayloadKind::Grid))));
  RtabmapDatabase database(fs::path(ZONEPACK_TEST_DATA) / "hospital-small.db");
  const MapDrawing source = drawing_of(database);
  EXPECT_EQ(packed.grids, 185u);
  EXPECT_EQ(packed.image.width, source.image.width);
  EXPECT_EQ(packed.image.height, source.image.height);
  // Votes are clamped, so another order of the signatures may decide a contested cell otherwise.
  std::size_t different = 0;
  for (std::size_t i = 0; i < packed.image.cells.size(); ++i) {
    different += packed.image.cells[i] != source.image.cells[i] ? 1 : 0;
  }
  EXPECT_LT(different, packed.image.cells.size() / 1000);
}

TEST(GroundOfAMap, IsMissingWithoutGridsAndWarnsOfADamagedPack) {
  const test_support::TemporaryFolder folder;
  const MapDrawing none =
      drawing_of(MapReader(build_map(folder / "core", kCoreOnly | mask_of(fb::PayloadKind::Scan))));
  EXPECT_TRUE(none.image.cells.empty());
  const std::string map = build_map(folder / "map", kCoreOnly | mask_of(fb::PayloadKind::Grid));
  const MapReader reader(map);
  std::ofstream(reader.pack_path(*reader.manifest().zones()->Get(0)), std::ios::trunc) << "gone";
  const MapDrawing rest = drawing_of(reader);
  ASSERT_EQ(rest.warnings.size(), 1u);
  EXPECT_NE(rest.warnings[0].find("zone 'C1' is left out of the floor plan"), std::string::npos)
      << rest.warnings[0];
  EXPECT_EQ(rest.grids, 176u);  // C1 has 9
}

}  // namespace
}  // namespace zonepack::packer
