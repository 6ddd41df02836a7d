// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/seen_places.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "packer/record/block_layers.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

struct Place {
  double x, y, z;
  Seen seen;
};

std::vector<Place> places_of(const SignatureRecord& record) {
  std::vector<Place> places;
  for_each_place(record, [&places](double x, double y, double z, Seen seen) {
    places.push_back({x, y, z, seen});
  });
  return places;
}

// Turned by 90 degrees at (10, 20, 1), mounted 0.5 m up.
SignatureRecord scan_record(const std::vector<std::array<float, 3>>& points, std::int32_t format) {
  SignatureRecord record;
  record.pose = Transform{0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 1};
  Scan& scan = record.scan.emplace();
  scan.format = format;
  scan.local_transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5F};
  scan.data = {1, static_cast<std::int32_t>(points.size()), 5 | (2 << 3), {}};
  scan.data.data.resize(points.size() * sizeof(points[0]));
  if (points.empty()) return record;
  std::memcpy(scan.data.data.data(), points.data(), scan.data.data.size());
  return record;
}

TEST(SeenPlaces, PutsPointsWhereTheyAreInTheMap) {
  const auto places = places_of(scan_record({{2, 0, 0.25F}}, 5));
  ASSERT_EQ(places.size(), 1u);
  EXPECT_DOUBLE_EQ(places[0].x, 10);
  EXPECT_DOUBLE_EQ(places[0].y, 22);
  EXPECT_DOUBLE_EQ(places[0].z, 1.75);
  EXPECT_EQ(places[0].seen, Seen::kSurface);
  EXPECT_DOUBLE_EQ(cell_size_of(scan_record({}, 5)), 0.05);
}

TEST(SeenPlaces, LeavesOutWhatIsNoPlace) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(places_of(scan_record({{kNan, 0, 0}, {0, kInf, 0}, {0, 0, 2e7F}, {0, 0, 0}}, 5)).size(),
            1u);
}

TEST(SeenPlaces, SeesNoHeightsInAScanOfOnePlane) {
  EXPECT_TRUE(places_of(scan_record({{1, 2, 3}}, 2)).empty());
  EXPECT_EQ(cell_size_of(scan_record({{1, 2, 3}}, 2)), 0);
  EXPECT_EQ(cell_size_of({}), 0);
}

// One block, the last of the cube that ends at the map's origin, with voxels given by their fields.
template <typename Voxel>
SignatureRecord block_record(VoxelLayer layer, double block_m,
                             const std::vector<std::pair<std::size_t, Voxel>>& voxels) {
  BlockLayers layers;
  layers.block_size_m = block_m;
  SignatureRecord record;
  BlockCube& cube = record.blocks.emplace();
  cube.index = {-1, -1, -1};
  cube.layers_info = write_block_layers(layers);
  BlockLayer& own = cube.layers[static_cast<std::size_t>(layer)];
  own.place = {static_cast<std::uint16_t>(place_in_cube(7, 7, 7))};
  own.voxels.resize(kVoxelsOfBlock * sizeof(Voxel));
  for (const auto& [place, voxel] : voxels) {
    std::memcpy(own.voxels.data() + place * sizeof(Voxel), &voxel, sizeof voxel);
  }
  return record;
}

struct Tsdf {
  float distance, weight;
};

TEST(SeenPlaces, SeesSurfacesAndFreeSpaceInATsdf) {
  const auto places = places_of(block_record<Tsdf>(
      VoxelLayer::kTsdf, 0.4F,
      {{0, {0.03F, 1}}, {1, {0.2F, 1}}, {2, {-0.1F, 1}}, {3, {0, 0}}, {511, {0.2F, 1e-6F}}}));
  ASSERT_EQ(places.size(), 4u);
  // The block's corner is at -0.4, a voxel is 0.05 m; z runs fastest.
  EXPECT_NEAR(places[0].x, -0.375, 1e-9);
  EXPECT_NEAR(places[0].z, -0.375, 1e-9);
  EXPECT_EQ(places[0].seen, Seen::kSurface);
  EXPECT_NEAR(places[1].z, -0.325, 1e-9);
  EXPECT_EQ(places[1].seen, Seen::kFree);
  EXPECT_EQ(places[2].seen, Seen::kSurface);
  EXPECT_NEAR(places[3].x, -0.025, 1e-9);
  EXPECT_NEAR(places[3].y, -0.025, 1e-9);
}

TEST(SeenPlaces, LeavesOutVoxelsThatAreNoNumbers) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(
      places_of(block_record<Tsdf>(VoxelLayer::kTsdf, 0.4F, {{0, {kNan, 1}}, {1, {1, kNan}}}))
          .empty());
}

TEST(SeenPlaces, TakesOccupancyAndEsdfWhereThereIsNoTsdf) {
  const auto odds = places_of(
      block_record<float>(VoxelLayer::kOccupancy, 0.4F, {{0, 1.5F}, {1, -1.5F}, {2, 0.0F}}));
  ASSERT_EQ(odds.size(), 2u);
  EXPECT_EQ(odds[0].seen, Seen::kSurface);
  EXPECT_EQ(odds[1].seen, Seen::kFree);
  struct Esdf {
    float square;
    std::array<std::int32_t, 3> parent;
    std::uint8_t inside, observed, site, padding;
  };
  const auto distances = places_of(block_record<Esdf>(VoxelLayer::kEsdf, 0.4F,
                                                      {{0, {0, {}, 0, 1, 1, 0}},
                                                       {1, {9, {}, 0, 1, 0, 0}},
                                                       {2, {9, {}, 1, 1, 0, 0}},
                                                       {3, {9, {}, 0, 0, 0, 0}}}));
  ASSERT_EQ(distances.size(), 2u);
  EXPECT_EQ(distances[0].seen, Seen::kSurface);
  EXPECT_EQ(distances[1].seen, Seen::kFree);
}

TEST(SeenPlaces, TakesCellsThatVoxelsFillWhole) {
  EXPECT_DOUBLE_EQ(cell_size_of(block_record<Tsdf>(VoxelLayer::kTsdf, 0.4F, {})), 0.05);
  EXPECT_DOUBLE_EQ(cell_size_of(block_record<Tsdf>(VoxelLayer::kTsdf, 0.16F, {})), 0.06);
  EXPECT_DOUBLE_EQ(cell_size_of(block_record<Tsdf>(VoxelLayer::kTsdf, 0.8F, {})), 0.1);
}

}  // namespace
}  // namespace zonepack::packer
