// SPDX-License-Identifier: Apache-2.0
// What is right in the database but fits in no pack costs its signature, not the map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <string>

#include "packer/build/map_builder.hpp"
#include "packer/verify/map_verifier.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

struct Case {
  std::string name, sql, column;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Unpackable : public testing::TestWithParam<Case> {};

TEST_P(Unpackable, IsNamedAndLeftOutOnRequest) {
  const test_support::TemporaryFolder folder;
  BuildOptions options;
  options.source = folder / "map.db";
  options.zones = folder / "zones.geojson";
  options.out = folder / "map";
  std::ofstream(options.zones) << R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"name": "hall", "zone_type": "corridor"}, "geometry":
     {"type": "Polygon", "coordinates": [[[0, 0], [1.5, 0], [1.5, 4], [0, 4], [0, 0]]]}},
    {"type": "Feature", "properties": {"name": "lab", "zone_type": "room"}, "geometry":
     {"type": "Polygon", "coordinates": [[[1.5, 0], [10, 0], [10, 4], [1.5, 4], [1.5, 0]]]}}]})";
  test_support::RtabmapFixture fixture;
  for (std::int32_t id = 1; id <= 3; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.x = static_cast<float>(id);
    recipe.y = 2;
    recipe.global_descriptor = true;
    if (id == 1)
      recipe.neighbours = {2};  // from one zone to the other: no edge without signature 2
    fixture.signatures.push_back(test_support::make_signature(recipe));
  }
  test_support::write_rtabmap_database(options.source.path, fixture);
  test_support::execute(options.source.path, GetParam().sql);
  std::ostringstream silent;
  Progress progress(silent, false);
  try {
    build_map(options, progress);
    FAIL() << "packed what fits in no pack";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("--damaged skip"));
    EXPECT_FALSE(std::filesystem::exists(options.out));  // nothing is left of it
    EXPECT_THAT(error.what(), HasSubstr(GetParam().column + ": "));
  }
  options.damaged = DamagedPolicy::kSkip;
  const BuildSummary summary = build_map(options, progress);
  EXPECT_EQ(summary.signatures, 2u);
  ASSERT_EQ(summary.damages.size(), 1u);
  EXPECT_EQ(summary.damages[0].column, GetParam().column);
  EXPECT_TRUE(verify_map(FolderFiles(options.out)).whole());
}

INSTANTIATE_TEST_SUITE_P(
    All, Unpackable,
    testing::Values(Case{"Label", "UPDATE Node SET label=printf('%.*c', 5000, 'x') WHERE id=2",
                         "Node.label"},
                    Case{"LabelOverTheReadersLimit",
                         "UPDATE Node SET label=printf('%.*c', 2000000, 'x') WHERE id=2", "Node"},
                    Case{"Sensors", "UPDATE Node SET env_sensors=zeroblob(4104) WHERE id=2",
                         "Node.env_sensors"},
                    Case{"Descriptor",
                         "UPDATE Feature SET descriptor=zeroblob(20000), descriptor_size=20000 "
                         "WHERE node_id=2",
                         "Feature.descriptor"},
                    Case{"Id", "UPDATE Node SET id=5000000000 WHERE id=2", "Node.id"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace zonepack::packer
