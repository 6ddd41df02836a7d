// SPDX-License-Identifier: Apache-2.0
// The outline reports what a database holds and what it lacks, without judging it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::bytes_of;
using test_support::execute;
using test_support::level_pose;
using test_support::make_signature;
using test_support::one_of_everything;
using test_support::RtabmapFixture;
using test_support::SignatureRecipe;
using test_support::write_rtabmap_database;
using test_support::zip;
using ::testing::HasSubstr;

class Outline : public ::testing::Test {
 protected:
  MapOutline outline() { return RtabmapDatabase(path_).outline(); }

  test_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "map.db";
};

TEST_F(Outline, OfAnEmptyDatabaseIsEmpty) {
  write_rtabmap_database(path_, RtabmapFixture());
  const MapOutline empty = outline();
  EXPECT_TRUE(empty.nodes.empty());
  EXPECT_FALSE(empty.has_optimised_poses);
  EXPECT_EQ(empty.feature_count, 0u);
  EXPECT_EQ(empty.scan_bytes, 0u);
  EXPECT_TRUE(empty.warnings.empty());
}

TEST_F(Outline, OfImagesOnlyHasNothingElse) {
  RtabmapFixture fixture;
  SignatureRecipe recipe;
  recipe.features = 0;
  recipe.scan_format = recipe.grid_channels = 0;
  fixture.signatures.push_back(make_signature(recipe));
  write_rtabmap_database(path_, fixture);
  EXPECT_EQ(outline().feature_count, 0u);
  EXPECT_EQ(outline().grid_bytes, 0u);
  const SignatureRecord record = RtabmapDatabase(path_).read(1, PayloadSet());
  EXPECT_EQ(record.features.count, 0u);
  EXPECT_EQ(record.features.descriptor_type, Features::DescriptorType::kNone);
  EXPECT_FALSE(record.scan.has_value());
  EXPECT_FALSE(record.image.empty());
}

TEST_F(Outline, OfADatabaseWithoutPayloadTablesWarns) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "DROP TABLE Feature; DROP TABLE Data; DROP TABLE Link; DROP TABLE Info");
  RtabmapDatabase database(path_);
  EXPECT_EQ(database.outline().warnings.size(), 3u);
  const SignatureRecord record = database.read(1, PayloadSet());
  EXPECT_EQ(record.features.count, 0u);
  EXPECT_TRUE(record.links.empty());
  EXPECT_TRUE(record.calibration.empty());
}

TEST_F(Outline, CountsNodesWithoutOptimisedPoseBySession) {
  RtabmapFixture fixture = one_of_everything("0.23.8");
  fixture.optimised_poses = false;
  write_rtabmap_database(path_, fixture);
  EXPECT_FALSE(outline().has_optimised_poses);
  EXPECT_EQ(outline().unlinked(), 23u);
  EXPECT_EQ(outline().nodes[0].pose, std::nullopt);
  EXPECT_NE(outline().nodes[0].odometry_pose, std::nullopt);
}

TEST_F(Outline, CountsPosesAndLinksOfNodesThatDoNotExist) {
  RtabmapFixture fixture = one_of_everything("0.23.8");
  fixture.extra_poses[77] = level_pose(1, 2);
  write_rtabmap_database(path_, fixture);
  execute(path_, "UPDATE Link SET to_id=78 WHERE from_id=3");
  EXPECT_EQ(outline().poses_without_node, 2u);  // 77, and 22, which was deleted
  EXPECT_EQ(outline().landmark_poses, 1u);
  EXPECT_EQ(outline().links_to_missing_nodes, 2u);  // 3 had two neighbours; landmark -5 is none
  EXPECT_EQ(RtabmapDatabase(path_).read(3, PayloadSet()).links[0].to, 78);
}

TEST_F(Outline, TotalsLeaveOutDeletedNodes) {
  RtabmapFixture fixture;
  for (std::int32_t id = 1; id <= 2; ++id) {
    SignatureRecipe recipe;
    recipe.id = id;
    fixture.signatures.push_back(make_signature(recipe));
  }
  fixture.signatures[1].weight = -9;
  write_rtabmap_database(path_, fixture);
  EXPECT_EQ(outline().feature_count, 20u);
  EXPECT_EQ(outline().scan_bytes, zip(fixture.signatures[0].scan->data).size());
  EXPECT_EQ(outline().grid_bytes, zip(*fixture.signatures[0].grid->obstacle).size() +
                                      zip(*fixture.signatures[0].grid->empty).size());
}

TEST_F(Outline, GivesTheOptimisedMap) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  const auto map = outline().optimised_map;
  ASSERT_TRUE(map.has_value());
  EXPECT_EQ(map->cells.rows, 2);
  EXPECT_EQ(map->cells.cols, 3);
  EXPECT_EQ(map->x_min, -1.5f);
  EXPECT_EQ(map->y_min, -2.0f);
  EXPECT_EQ(map->resolution, 0.05f);
}

TEST_F(Outline, DoesWithoutAMapOrParametersThatCannotBeRead) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "UPDATE Admin SET opt_map=?1", Bytes(40, std::byte{7}));
  execute(path_, "UPDATE Info SET parameters=?1", Bytes(40, std::byte{7}));
  EXPECT_FALSE(outline().optimised_map.has_value());
  ASSERT_EQ(outline().warnings.size(), 2u);
  EXPECT_THAT(outline().warnings[0], HasSubstr("Admin.opt_map: "));
  EXPECT_THAT(outline().warnings[1], HasSubstr("Info.parameters: "));
}

TEST_F(Outline, RefusesPosesThatDoNotMatchTheirIds) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  const auto refusal = [&](const char* column, const Bytes& blob) -> std::string {
    execute(path_, std::string("UPDATE Admin SET ") + column + "=?1", blob);
    try {
      outline();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "not refused";
  };
  const Bytes two_ids = zip({1, 2, 4, bytes_of(std::vector<std::int32_t>{1, 2})});
  EXPECT_THAT(refusal("opt_ids", two_ids), HasSubstr("holds 2 ids"));
  EXPECT_THAT(refusal("opt_poses", zip({1, 24, 6, Bytes(192)})), HasSubstr("expected 1 x float32"));
  EXPECT_THAT(refusal("opt_poses", Bytes(60, std::byte{1})), HasSubstr("Admin.opt_poses: "));
  EXPECT_EQ(refusal("opt_poses", zip({1, 24, 5, Bytes(96)})), "not refused");
  EXPECT_EQ(outline().unlinked(), 23u);  // all zero: no pose
}

TEST_F(Outline, TakesNoSideWhenAnIdHasTwoPoses) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  std::vector<float> poses;
  for (const Transform& pose : {level_pose(1, 1), level_pose(9, 9)}) {
    poses.insert(poses.end(), pose.begin(), pose.end());
  }
  execute(path_, "UPDATE Admin SET opt_ids=?1",
          zip({1, 2, 4, bytes_of(std::vector<std::int32_t>{5, 5})}));
  execute(path_, "UPDATE Admin SET opt_poses=?1", zip({1, 24, 5, bytes_of(poses)}));
  ASSERT_EQ(outline().damages.size(), 1u);
  EXPECT_EQ(outline().damages[0].signature, 5);
  EXPECT_EQ(outline().damages[0].column, "Admin.opt_ids");
}

TEST_F(Outline, CountsNodeIdsThatRtabmapCannotHaveAsDamaged) {
  write_rtabmap_database(path_, one_of_everything("0.23.8"));
  execute(path_, "UPDATE Node SET id=5000000000 WHERE id=24");
  ASSERT_EQ(outline().damages.size(), 1u);
  EXPECT_EQ(outline().damages[0].column, "Node.id");
  execute(path_, "UPDATE Node SET id=0 WHERE id=5000000000");
  ASSERT_EQ(outline().damages.size(), 1u);
  EXPECT_EQ(outline().find(0), nullptr);
}

}  // namespace
}  // namespace zonepack::packer
