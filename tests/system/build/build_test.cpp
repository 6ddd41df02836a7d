// SPDX-License-Identifier: Apache-2.0
// What `zonepack build` makes of databases of every kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/system/build/packer_program.hpp"
#include "tests/system/round_trip/expected_signature.hpp"

namespace zonepack::system_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(Build, RefusesADatabaseWithoutSignatures) {
  const Packer packer;
  packer.write_database({});
  const Outcome outcome = packer.build();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("map.db: the database holds no signatures"));
  EXPECT_FALSE(std::filesystem::exists(packer.path("map/manifest.zpm")));
}

TEST(Build, PacksADatabaseWithoutFeaturesAndSaysSo) {
  const Packer packer;
  test_support::RtabmapFixture fixture = four_signatures();
  for (auto& signature : fixture.signatures) signature.features = {};
  packer.write_database(fixture);
  const Outcome outcome = packer.build();
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("no signature has features"));
  const auto signatures = packer.exported();
  ASSERT_EQ(signatures.size(), 4u);
  EXPECT_EQ(signatures.at(1)["keypoints"], json::array());
  EXPECT_EQ(signatures.at(1)["word_ids"], json::array());
  EXPECT_EQ(signatures.at(1)["descriptors"], json());
  EXPECT_EQ(signatures.at(1)["descriptor_type"], json());
  EXPECT_FALSE(signatures.at(1)["scan"].is_null());
}

TEST(Build, PacksADatabaseOfImagesOnly) {
  const Packer packer;
  test_support::RtabmapFixture fixture = four_signatures();
  for (auto& signature : fixture.signatures) {
    signature.features = {};
    signature.scan.reset();
    signature.grid.reset();
    signature.calibration.clear();
  }
  packer.write_database(fixture);
  const json summary = packer.build_summary();
  EXPECT_EQ(summary["signatures"], 4);
  EXPECT_EQ(summary["features"], 0);
  const auto signatures = packer.exported();
  for (const char* key : {"scan", "grid", "depth", "calibration", "user_data", "descriptors"}) {
    EXPECT_TRUE(signatures.at(1)[key].is_null()) << key;
  }
  EXPECT_TRUE(signatures.at(1)["image"].is_string());
}

class BuildOfSchema : public ::testing::TestWithParam<const char*> {};

TEST_P(BuildOfSchema, CarriesEverySignatureThatHasAPose) {
  const Packer packer;
  packer.write_database(test_support::one_of_everything(GetParam()));
  const json summary = packer.build_summary();
  // Of 24, 22 is deleted. 20 has no odometry pose, and before 0.13 no optimised ones were saved.
  const bool optimised = std::string(GetParam()) >= "0.13";
  const std::size_t packed = optimised ? 23 : 22;
  EXPECT_EQ(summary["schema_version"], GetParam());
  EXPECT_EQ(summary["signatures_deleted"], 1);
  EXPECT_EQ(summary["signatures"], packed);
  EXPECT_EQ(summary["signatures_unlinked_dropped"], 23 - packed);
  EXPECT_EQ(summary["orphans"], 0);
  const auto signatures = packer.exported();
  EXPECT_EQ(signatures.size(), packed);
  EXPECT_FALSE(signatures.contains(22));
  EXPECT_EQ(signatures.at(21)["weight"], -1);
  EXPECT_EQ(signatures.at(12)["zone"], "west");
  EXPECT_EQ(signatures.at(13)["zone"], "east");
  EXPECT_TRUE(signatures.at(16)["pose"].is_null());
}

INSTANTIATE_TEST_SUITE_P(All, BuildOfSchema,
                         ::testing::Values("0.11.0", "0.11.13", "0.12.4", "0.13.2", "0.16.3",
                                           "0.17.6", "0.18.0", "0.20.0", "0.22.1", "0.23.8"));

// Scans of all 12 formats, grids in the plane and in space, every encoding of depth, descriptors of
// both kinds, stereo, priors, landmarks: compared with what SQLite and zlib alone read.
TEST(Build, CarriesOneOfEverythingBitForBit) {
  const Packer packer;
  packer.write_database(test_support::one_of_everything("0.23.8"));
  packer.build_summary();
  const round_trip::ExpectedSignatures expected(packer.path("map.db"));
  const auto signatures = packer.exported();
  ASSERT_EQ(signatures.size(), expected.ids().size());
  for (const std::int64_t id : expected.ids()) {
    const json wanted =
        expected.signature(id, {"features", "scan", "grid", "image", "depth", "userdata"});
    EXPECT_EQ(round_trip::first_difference(wanted, signatures.at(id)), "") << id;
  }
}

TEST(Build, PacksOnlyThePayloadsAskedFor) {
  const Packer packer;
  packer.write_database(test_support::one_of_everything("0.23.8"));
  const json all = packer.build_summary();
  const json some = packer.build_summary("--payload grid,depth");
  EXPECT_LT(some["pack_bytes"], all["pack_bytes"]);
  const auto signatures = packer.exported();
  const json& signature = signatures.at(10);
  for (const char* key : {"keypoints", "points", "word_ids", "descriptors", "scan", "image",
                          "user_data", "global_descriptors"}) {
    EXPECT_TRUE(signature[key].is_null()) << key;
  }
  EXPECT_TRUE(signature["depth"].is_string());
  EXPECT_TRUE(signature["grid"].is_object());
  EXPECT_TRUE(signature["calibration"].is_string());
  EXPECT_FALSE(signature["links"].empty());
}

TEST(Build, TreatsSignaturesInNoZoneAsAsked) {
  const Packer packer;
  packer.write_database(four_signatures());
  packer.write("zones.geojson", two_rooms(2.5));  // 1 and 2 stand west of it
  const json nearest = packer.build_summary();
  EXPECT_EQ(nearest["orphans"], 2);
  EXPECT_EQ(nearest["orphans_dropped"], 0);
  EXPECT_EQ(nearest["signatures"], 4);
  const json drop = packer.build_summary("--orphans drop");
  EXPECT_EQ(drop["orphans_dropped"], 2);
  EXPECT_EQ(drop["signatures"], 2);
  const Outcome error = packer.build("--orphans error");
  EXPECT_EQ(error.exit_code, 1);
  EXPECT_THAT(error.output, HasSubstr("--orphans"));
}

TEST(Build, TreatsSignaturesWithoutAnOptimisedPoseAsAsked) {
  const Packer packer;
  test_support::RtabmapFixture fixture = four_signatures();
  fixture.signatures[3].pose.reset();
  packer.write_database(fixture);
  const Outcome odometry = packer.build();
  EXPECT_EQ(odometry.exit_code, 0);
  EXPECT_THAT(odometry.output, HasSubstr("WARNING: 1 signature has no optimised pose"));
  EXPECT_EQ(packer.exported().size(), 4u);
  const json drop = packer.build_summary("--unlinked drop");
  EXPECT_EQ(drop["signatures"], 3);
  EXPECT_EQ(drop["signatures_unlinked"]["0"], 1);
  const Outcome error = packer.build("--unlinked error");
  EXPECT_EQ(error.exit_code, 1);
  EXPECT_THAT(error.output, HasSubstr("--unlinked odometry or drop"));
}

// The odometry of a session that nothing joins to the map starts at a place of its own.
TEST(Build, LeavesOutSessionsThatAreConnectedToNoOther) {
  const Packer packer;
  test_support::RtabmapFixture fixture = four_signatures();
  fixture.signatures[3].pose.reset();
  fixture.signatures[3].map_id = 7;
  packer.write_database(fixture);
  const Outcome dropped = packer.build();
  EXPECT_EQ(dropped.exit_code, 0) << dropped.output;
  EXPECT_THAT(dropped.output,
              HasSubstr("session 7 with its 1 signature is connected to no other, so nothing says "
                        "where it is; it is left out. Keep it with --unlinked odometry-all"));
  EXPECT_EQ(packer.exported().size(), 3u);
  EXPECT_EQ(packer.build("--unlinked odometry-all").exit_code, 0);
  EXPECT_EQ(packer.exported().size(), 4u);
}

TEST(Build, TreatsDamagedSignaturesAsAsked) {
  const Packer packer;
  packer.write_database(four_signatures());
  test_support::execute(packer.path("map.db"), "UPDATE Data SET scan = x'0102' WHERE id = 3");
  const Outcome error = packer.build();
  EXPECT_EQ(error.exit_code, 1);
  EXPECT_THAT(error.output, HasSubstr("signature 3, Data.scan"));
  EXPECT_THAT(error.output, HasSubstr("--damaged skip"));
  const json skip = packer.build_summary("--damaged skip");
  EXPECT_EQ(skip["signatures"], 3);
  ASSERT_EQ(skip["damaged"].size(), 1u);
  EXPECT_EQ(skip["damaged"][0]["signature"], 3);
  EXPECT_EQ(skip["damaged"][0]["column"], "Data.scan");
  EXPECT_FALSE(packer.exported().contains(3));
}

TEST(Build, GivesTheSameBytesOnAnyNumberOfJobs) {
  const Packer packer;
  packer.write_database(test_support::one_of_everything("0.23.8"));
  std::map<std::string, std::string> first;
  for (const char* jobs : {"1", "2", "7"}) {
    std::filesystem::remove_all(packer.path("map"));
    packer.build_summary(std::string("--jobs ") + jobs);
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(packer.path("map"))) {
      files[entry.path().filename()] = bytes_of_file(entry.path());
    }
    EXPECT_EQ(files.size(), 3u);
    if (first.empty()) first = files;
    EXPECT_TRUE(files == first) << jobs;
  }
}

}  // namespace
}  // namespace zonepack::system_test
