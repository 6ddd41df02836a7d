// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/check_zones.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kZones = ZONEPACK_TEST_DATA "/zones.geojson";
const std::filesystem::path kDatabase = ZONEPACK_TEST_DATA "/hospital-small.db";

ordered_json hospital() {
  std::ifstream file(kZones);
  return ordered_json::parse(file);
}

std::string written(const test_support::TemporaryFolder& folder, const ordered_json& zones) {
  const std::string path = folder / "zones.geojson";
  std::ofstream(path) << zones.dump(1);
  return path;
}

TEST(CheckZones, AcceptsTheHospital) {
  std::ostringstream text;
  ordered_json json;
  EXPECT_EQ(check_zones({kZones, std::nullopt, 0.1}, text, json), 0);
  EXPECT_THAT(text.str(), AllOf(HasSubstr("24 zones, 28 portals; 0 faults, 0 warnings"),
                                Not(HasSubstr("signatures"))));
  EXPECT_EQ(json["faults"].size(), 0u);
  EXPECT_EQ(json["zones"].size(), 24u);
  EXPECT_EQ(json["zones"][8]["name"], "L1");
  EXPECT_EQ(json["zones"][8]["zone_type"], "lobby");
  EXPECT_EQ(json["zones"][8]["area_m2"], 196.0);
  EXPECT_EQ(json["zones"][8]["portals"], 11);
  EXPECT_FALSE(json["zones"][8].contains("signatures"));
  EXPECT_EQ(json["portals"].size(), 28u);
  EXPECT_EQ(
      json["portals"][1].dump(),
      R"({"name":"P02","zones":["L1","H1"],"line":[[-6.375,0.0],[-3.675,0.0]],"length_m":2.7})");
}

TEST(CheckZones, CountsTheSignaturesOfADatabase) {
  std::ostringstream text;
  ordered_json json;
  EXPECT_EQ(check_zones({kZones, kDatabase, 0.1}, text, json), 0);
  EXPECT_EQ(json["zones"][8]["signatures"], 31);
  EXPECT_EQ(json["signatures"]["in_zones"], 185);
  EXPECT_EQ(json["signatures"]["unlinked"], 0);
  EXPECT_EQ(json["signatures"]["orphans"].size(), 0u);
  EXPECT_THAT(text.str(), HasSubstr("185 signatures in zones, 0 in none"));
}

TEST(CheckZones, ListsOrphansAndZonesWithoutSignatures) {
  const test_support::TemporaryFolder folder;
  ordered_json zones = hospital();
  auto& features = zones["features"];
  ASSERT_EQ(features[6]["properties"]["name"], "H5");  // 2 signatures
  for (auto& point : features[6]["geometry"]["coordinates"][0]) {
    point[0] = point[0].get<double>() + 50;
  }
  for (std::size_t i = features.size(); i-- > 0;) {
    if (features[i]["properties"]["name"] == "P13") features.erase(i);  // L2-H5
  }
  std::ostringstream text;
  ordered_json json;
  EXPECT_EQ(check_zones({written(folder, zones), kDatabase, 0.1}, text, json), 0);
  EXPECT_EQ(json["signatures"]["orphans"].size(), 2u);
  EXPECT_EQ(json["signatures"]["in_zones"], 183);
  const auto& orphan = json["signatures"]["orphans"][0];
  EXPECT_TRUE(orphan["id"].is_number_integer());
  EXPECT_GT(orphan["distance_m"], 0);
  EXPECT_THAT(text.str(), AllOf(HasSubstr("183 signatures in zones, 2 in none"),
                                HasSubstr("zone 'H5' holds no signature"),
                                HasSubstr("zone 'H5' is unreachable")));
}

TEST(CheckZones, ReportsEveryFaultWithItsLineAndReturnsOne) {
  const test_support::TemporaryFolder folder;
  ordered_json zones = hospital();
  auto& features = zones["features"];
  std::swap(features[1]["geometry"]["coordinates"][0][1],
            features[1]["geometry"]["coordinates"][0][2]);  // L2 crosses itself
  features[5]["properties"]["name"] = "H1";                 // H4 takes H1's name
  std::ostringstream text;
  ordered_json json;
  const std::string path = written(folder, zones);
  EXPECT_EQ(check_zones({path, kDatabase, 0.1}, text, json), 1);
  EXPECT_THAT(text.str(), AllOf(HasSubstr("zone 'L2' (feature 1) crosses itself"),
                                HasSubstr("zone name 'H1' (feature 5) is taken by feature 2"),
                                HasSubstr("names zone 'H4', which is not in the file"),
                                HasSubstr(path + ":"), HasSubstr("Mend the faults")));
  EXPECT_EQ(json["faults"].size(), 3u);
  EXPECT_EQ(json["faults"][0]["name"], "L2");
  EXPECT_EQ(json["faults"][0]["feature"], 1);
  EXPECT_GT(json["faults"][0]["line"], 50);
}

TEST(CheckZones, NamesFaultsLastAndDrawsThemOverTheGrid) {
  const test_support::TemporaryFolder folder;
  ordered_json zones = hospital();
  std::swap(zones["features"][1]["geometry"]["coordinates"][0][1],
            zones["features"][1]["geometry"]["coordinates"][0][2]);  // L2 crosses itself
  std::ostringstream text;
  ordered_json json;
  const std::string path = written(folder, zones), out = folder / "preview.html";
  EXPECT_EQ(check_zones({path, kDatabase, 0.1, out}, text, json), 1);
  const std::string lines = text.str();
  EXPECT_LT(lines.find("R52"), lines.find("fault: "));
  EXPECT_LT(lines.find(" in none"), lines.find("fault: "));
  EXPECT_EQ(json["picture"], out);
  EXPECT_NEAR(json["faults"][0]["at"][0], 3.6, 1e-9);  // as the message says
  EXPECT_NEAR(json["faults"][0]["at"][1], 14.4, 1e-9);
  std::ostringstream page;
  page << std::ifstream(out).rdbuf();
  const auto holds = [&](const char* words) { return page.str().find(words) != std::string::npos; };
  EXPECT_TRUE(holds("href=\"data:image/png;base64,"));
  EXPECT_TRUE(holds(">signature in no zone<"));
  EXPECT_TRUE(holds("<td>zone &#39;L2&#39; (feature 1) crosses itself"));
}

TEST(CheckZones, RecognisesSwappedAxes) {
  const test_support::TemporaryFolder folder;
  ordered_json zones = hospital();
  for (auto& feature : zones["features"]) {
    auto& coordinates = feature["geometry"]["coordinates"];
    for (auto& point : feature["geometry"]["type"] == "Polygon" ? coordinates[0] : coordinates) {
      std::swap(point[0], point[1]);
    }
  }
  std::ostringstream text;
  ordered_json json;
  check_zones({written(folder, zones), kDatabase, 0.1}, text, json);
  EXPECT_THAT(text.str(), HasSubstr(" of 185 in no zone; with x and y swapped 0"));
  EXPECT_EQ(json["signatures"]["read_otherwise"]["how"], "x and y swapped");
}

TEST(CheckZones, ListsZonesInNaturalOrder) {
  const test_support::TemporaryFolder folder;
  ordered_json zones = hospital();
  zones["features"][0]["properties"]["name"] = "L10";
  std::ostringstream text;
  ordered_json json;
  check_zones({written(folder, zones), std::nullopt, 0.1}, text, json);
  EXPECT_LT(text.str().find("\nL2 "), text.str().find("\nL10 "));
}

TEST(CheckZones, ReportsAFileThatIsNoJson) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder / "zones.geojson";
  std::ofstream(path) << "{\n  \"type\": \"FeatureCollection\"\n  \"features\": []\n}\n";
  std::ostringstream text;
  ordered_json json;
  EXPECT_EQ(check_zones({path, kDatabase, 0.1}, text, json), 1);
  EXPECT_THAT(text.str(), HasSubstr(path + ":3: not valid JSON"));
}

int run(std::vector<std::string> arguments) {
  CLI::App app;
  int exit_code = -1;
  add_check_zones_command(app, exit_code);
  std::reverse(arguments.begin(), arguments.end());
  app.parse(arguments);
  return exit_code;
}

TEST(CheckZonesCommand, WritesJsonAndSetsTheExitCode) {
  const test_support::TemporaryFolder folder;
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run({"check-zones", kZones, "--json", folder / "out.json"}), 0);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("24 zones"));
  std::ifstream file(folder / "out.json");
  EXPECT_EQ(ordered_json::parse(file)["zones"].size(), 24u);
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run({"check-zones", kZones, "--snap", "0.02"}), 1);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("13 faults"));
}

TEST(CheckZonesCommand, RefusesWrongUsage) {
  EXPECT_THROW(run({"check-zones"}), CLI::ParseError);
  EXPECT_THROW(run({"check-zones", kZones, "--snap", "-1"}), CLI::ParseError);
  EXPECT_THROW(run({"check-zones", kZones, "--snap", "nan"}), CLI::ParseError);
  EXPECT_THROW(run({"check-zones", "/no/such/file"}), std::runtime_error);
}

}  // namespace
}  // namespace zonepack::packer
