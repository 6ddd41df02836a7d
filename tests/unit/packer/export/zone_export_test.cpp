// SPDX-License-Identifier: Apache-2.0
#include "packer/export/zone_export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "packer/build/map_builder.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

// One of everything in one zone, and a signature whose links take several records.
class ZoneExport : public ::testing::Test {
 protected:
  ZoneExport() {
    auto fixture = test_support::one_of_everything("0.23.8");
    for (std::int32_t to = 1000; to < 1100; ++to) {
      fixture.signatures[7].links.push_back(
          test_support::make_link(to, 1, test_support::level_pose(1, 2)));
    }
    test_support::write_rtabmap_database(folder_ / "map.db", fixture);
    std::ofstream(folder_ / "zones.geojson")
        << R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":)"
        << R"({"name":"hall","zone_type":"hall"},"geometry":{"type":"Polygon","coordinates":)"
        << "[[[0,-5],[30,-5],[30,5],[0,5],[0,-5]]]}}]}";
    BuildOptions options;
    options.source = folder_ / "map.db";
    options.zones = folder_ / "zones.geojson";
    options.out = folder_ / "map";
    std::ostringstream ignored;
    Progress progress(ignored, false);
    build_map(options, progress);
  }

  std::string exported(ByteCount window_bytes) const {
    const MapReader map(folder_ / "map");
    std::string text;
    JsonLines json([&](std::string_view piece) { text += piece; });
    export_zone(map, *map.manifest().zones()->Get(0), json, window_bytes);
    json.flush();
    return text;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(ZoneExport, PrintsTheSameInWindowsOfAnyLength) {
  const std::string whole = exported(8 * kMiB);
  EXPECT_EQ(std::count(whole.begin(), whole.end(), '\n'), 23);
  for (const ByteCount window : {ByteCount{1}, 10 * kKiB, 30 * kKiB, 100 * kKiB}) {
    EXPECT_TRUE(exported(window) == whole) << window;
  }
}

TEST_F(ZoneExport, NamesThePackThatIsDamaged) {
  const MapReader map(folder_ / "map");
  const std::string pack = map.pack_path(*map.manifest().zones()->Get(0));
  std::fstream file(pack, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(2000);
  file.put('!');
  file.close();
  try {
    exported(8 * kMiB);
    ADD_FAILURE() << "exported a damaged pack";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(pack + ": bad checksum"));
    EXPECT_THAT(error.what(), HasSubstr("zonepack verify"));
  }
}

TEST_F(ZoneExport, NamesThePackThatIsMissing) {
  const MapReader map(folder_ / "map");
  const std::string pack = map.pack_path(*map.manifest().zones()->Get(0));
  std::filesystem::remove(pack);
  try {
    exported(8 * kMiB);
    ADD_FAILURE() << "exported a missing pack";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(pack + ": not found"));
  }
}

TEST_F(ZoneExport, RefusesAnotherMapsPackUnderTheRightName) {
  const MapReader map(folder_ / "map");
  const std::string pack = map.pack_path(*map.manifest().zones()->Get(0));
  {
    PackWriter writer(folder_.path(), "hall");
    const PackSummary other = writer.finish(kEveryPayload);
    std::filesystem::rename(folder_ / other.file, pack);
  }
  EXPECT_THROW(exported(8 * kMiB), std::runtime_error);
}

}  // namespace
}  // namespace zonepack::packer
