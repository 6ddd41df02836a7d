// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/outline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;
using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

ordered_json outline_of(const std::filesystem::path& db, const std::filesystem::path& out,
                        std::string* printed = nullptr) {
  std::ostringstream text;
  ordered_json json;
  write_outline({db, out}, text, json);
  if (printed != nullptr) *printed = text.str();
  return json;
}

TEST(OutlineFiles, DrawsTheHospital) {
  const TemporaryFolder folder;
  std::string printed;
  const ordered_json json =
      outline_of(ZONEPACK_TEST_DATA "/hospital-small.db", folder / "new/out", &printed);
  const std::filesystem::path out = folder / "new/out";
  EXPECT_THAT(names_in(out), ElementsAre("map.pgm", "map.wld", "map.yaml", "signatures.geojson",
                                         "trajectories.geojson"));
  EXPECT_EQ(json["signatures"], 185);
  EXPECT_EQ(json["trajectories"], 1);
  EXPECT_EQ(json["map"]["source"], "local grids");
  EXPECT_EQ(json["map"]["grids"], 185);
  EXPECT_EQ(json["map"]["resolution_m"], 0.05);
  EXPECT_THAT(printed, AllOf(HasSubstr("185 signatures, 1 trajectory"), HasSubstr("QGIS"),
                             HasSubstr("EPSG:3857"), HasSubstr("zonepack check-zones")));
  EXPECT_EQ(ordered_json::parse(text_of(out / "signatures.geojson"))["features"].size(), 185u);

  // The building is 25 m x 56 m; its upper third is outdoors or closed.
  const std::size_t width = json["map"]["width"], height = json["map"]["height"];
  EXPECT_NEAR(static_cast<double>(width) * 0.05, 26, 1);
  EXPECT_NEAR(static_cast<double>(height) * 0.05, 57, 1.5);
  const std::string pgm = text_of(out / "map.pgm");
  const std::string header =
      "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  ASSERT_EQ(pgm.substr(0, header.size()), header);
  ASSERT_EQ(pgm.size(), header.size() + width * height);
  const double x0 = json["map"]["origin"][0], y0 = json["map"]["origin"][1];
  const auto darkest_near = [&](double x, double y) {  // within 15 cm: walls are 10 cm thick
    int darkest = 255;
    for (int i = -3; i <= 3; ++i) {
      for (int j = -3; j <= 3; ++j) {
        const auto column = static_cast<std::size_t>((x - x0) / 0.05 + i);
        const auto row = static_cast<std::size_t>((y - y0) / 0.05 + j);
        const std::size_t at = header.size() + (height - 1 - row) * width + column;
        darkest = std::min(darkest, int(static_cast<unsigned char>(pgm[at])));
      }
    }
    return darkest;
  };
  EXPECT_EQ(darkest_near(0, 10), 254);    // the lobby
  EXPECT_EQ(darkest_near(-5, -15), 254);  // the west corridor
  EXPECT_EQ(darkest_near(0, -34), 254);   // the rear corridor
  EXPECT_EQ(darkest_near(0, -2), 0);      // the wall between the offices R31 and R32
  EXPECT_EQ(darkest_near(-6.5, -3), 0);   // the wall between corridor and west front ward
}

TEST(OutlineFiles, TakesTheDatabasesOwnMapWhereThereIsOne) {
  const TemporaryFolder folder;
  test_support::RtabmapFixture fixture;
  test_support::SignatureRecipe recipe;
  fixture.signatures = {test_support::make_signature(recipe)};
  OptimisedMap own;
  own.cells = {2, 2, 0, {std::byte{0}, std::byte{100}, std::byte{0xFF}, std::byte{0}}};
  own.cells.type = 1;  // int8
  own.x_min = -2;
  own.y_min = 3;
  own.resolution = 0.1f;
  fixture.optimised_map = own;
  test_support::write_rtabmap_database(folder / "map.db", fixture);
  const ordered_json json = outline_of(folder / "map.db", folder / "out");
  EXPECT_EQ(json["map"]["source"], "the database's own map");
  EXPECT_EQ(text_of(folder / "out/map.pgm"), std::string("P5\n2 2\n255\n\xCD\xFE\xFE\x00", 15));
  EXPECT_THAT(text_of(folder / "out/map.yaml"), HasSubstr("origin: [-2, 3, 0.0]"));
}

TEST(OutlineFiles, SaysWhenThereIsNothingToDrawAMapFrom) {
  const TemporaryFolder folder;
  test_support::RtabmapFixture fixture;
  test_support::SignatureRecipe recipe;
  recipe.grid_channels = 0;
  fixture.signatures = {test_support::make_signature(recipe)};
  recipe.id = 2;
  recipe.x = 1;
  fixture.signatures.push_back(test_support::make_signature(recipe));
  fixture.signatures[1].pose.reset();
  test_support::write_rtabmap_database(folder / "map.db", fixture);
  std::string printed;
  const ordered_json json = outline_of(folder / "map.db", folder / "out", &printed);
  EXPECT_THAT(names_in(folder / "out"), ElementsAre("signatures.geojson", "trajectories.geojson"));
  EXPECT_TRUE(json["map"].is_null());
  EXPECT_EQ(json["unlinked"], 1);
  EXPECT_THAT(printed, AllOf(HasSubstr("no local grids"),
                             HasSubstr("1 of 2 signatures have no optimised pose")));
}

TEST(OutlineFiles, LeavesOutADamagedGridAndSaysSo) {
  const TemporaryFolder folder;
  test_support::RtabmapFixture fixture;
  test_support::SignatureRecipe recipe;
  fixture.signatures = {test_support::make_signature(recipe)};
  recipe.id = 2;
  fixture.signatures.push_back(test_support::make_signature(recipe));
  test_support::write_rtabmap_database(folder / "map.db", fixture);
  test_support::execute(folder / "map.db",
                        "UPDATE Data SET empty_cells = x'0102030405060708' WHERE id = 2");
  std::string printed;
  const ordered_json json = outline_of(folder / "map.db", folder / "out", &printed);
  EXPECT_EQ(json["map"]["grids"], 1);
  EXPECT_THAT(printed, AllOf(HasSubstr("signature 2"), HasSubstr("left out of the floor plan")));
}

TEST(OutlineFiles, LeavesOldFilesWhenItFails) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "out/trajectories.geojson");
  std::ofstream(folder / "out/map.pgm") << "old";
  EXPECT_THROW(outline_of(ZONEPACK_TEST_DATA "/hospital-small.db", folder / "out"),
               std::runtime_error);
  EXPECT_EQ(text_of(folder / "out/map.pgm"), "old");
  EXPECT_THAT(names_in(folder / "out"), ElementsAre("map.pgm", "trajectories.geojson"));
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(outline_of(ZONEPACK_TEST_DATA "/hospital-small.db", folder / "file"),
               std::runtime_error);
}

TEST(OutlineFiles, GivesTheSameBytesTwice) {
  const TemporaryFolder folder;
  outline_of(ZONEPACK_TEST_DATA "/hospital-small.db", folder / "a");
  outline_of(ZONEPACK_TEST_DATA "/hospital-small.db", folder / "b");
  for (const std::string& name : names_in(folder / "a")) {
    EXPECT_EQ(text_of(folder / "a" / name), text_of(folder / "b" / name)) << name;
  }
}

TEST(OutlineCommand, NeedsADatabaseAndAFolder) {
  CLI::App app;
  int exit_code = -1;
  add_outline_command(app, exit_code);
  EXPECT_THROW(app.parse("outline --db x.db"), CLI::ParseError);
  EXPECT_THROW(app.parse("outline --out x"), CLI::ParseError);
  EXPECT_THROW(app.parse("outline --db /no/such.db --out /tmp/never"), std::runtime_error);
  EXPECT_EQ(exit_code, -1);
}

}  // namespace
}  // namespace zonepack::packer
