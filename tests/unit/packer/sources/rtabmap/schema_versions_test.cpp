// SPDX-License-Identifier: Apache-2.0
// Every schema from 0.11 to 0.23 reads back what was written, as far as the schema holds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::execute;
using test_support::expected_records;
using test_support::first_difference;
using test_support::one_of_everything;
using test_support::RtabmapFixture;
using test_support::TemporaryFolder;
using test_support::write_rtabmap_database;

class SchemaVersions : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "map.db";
};

TEST_P(SchemaVersions, EverySignatureReadsBackAsItWasWritten) {
  const RtabmapFixture fixture = one_of_everything(GetParam());
  write_rtabmap_database(path_, fixture);
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.outline().schema_version, GetParam());
  const auto expected = expected_records(fixture);
  ASSERT_EQ(database.outline().nodes.size(), expected.size());
  SignatureRecord record;
  for (const SignatureRecord& wanted : expected) {
    database.read(wanted.id, PayloadSet(), record);
    EXPECT_EQ(first_difference(record, wanted), "") << "signature " << wanted.id;
  }
}

TEST_P(SchemaVersions, OutlineCountsWhatIsDroppedAndUnlinked) {
  write_rtabmap_database(path_, one_of_everything(GetParam()));
  const MapOutline outline = RtabmapDatabase(path_).outline();
  EXPECT_EQ(outline.deleted_nodes, 1u);
  EXPECT_TRUE(outline.warnings.empty());
  EXPECT_TRUE(outline.damages.empty());
  EXPECT_EQ(outline.parameter("Kp/MaxFeatures"), "400");
  if (outline.has_optimised_poses) {
    // 16 of session 0; 23 and 24 of session 1.
    EXPECT_EQ(outline.unlinked_by_session, (std::map<std::int32_t, std::size_t>{{0, 1}, {1, 2}}));
    EXPECT_EQ(outline.landmark_poses, 1u);
  } else {
    // 1 to 16 and 17 to 24 without the deleted 22.
    EXPECT_EQ(outline.unlinked_by_session, (std::map<std::int32_t, std::size_t>{{0, 16}, {1, 7}}));
  }
}

TEST_P(SchemaVersions, ReadsTheSameWithoutAnyIndex) {
  const RtabmapFixture fixture = one_of_everything(GetParam());
  write_rtabmap_database(path_, fixture);
  const std::string features = fixture.version < "0.13" ? "Map_Node_Word" : "Feature";
  execute(path_, "DROP INDEX IDX_" + features + "_node_id; DROP INDEX IDX_Link_from_id;");
  // Rows of one signature in two places of the table.
  execute(path_, "INSERT INTO " + features + " SELECT * FROM " + features + " WHERE node_id=7");
  RtabmapDatabase database(path_);
  for (const SignatureRecord& wanted : expected_records(fixture)) {
    const SignatureRecord record = database.read(wanted.id, PayloadSet());
    if (wanted.id == 7) {
      EXPECT_EQ(record.features.count, 2 * wanted.features.count);
    } else {
      EXPECT_EQ(first_difference(record, wanted), "") << "signature " << wanted.id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SchemaVersions,
                         ::testing::Values("0.11.0", "0.11.8", "0.11.13", "0.12.4", "0.13.2",
                                           "0.16.0", "0.16.3", "0.17.6", "0.18.0", "0.20.0",
                                           "0.22.1", "0.23.8"),
                         [](const auto& version) {
                           std::string name = version.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return "Schema_" + name;
                         });

}  // namespace
}  // namespace zonepack::packer
