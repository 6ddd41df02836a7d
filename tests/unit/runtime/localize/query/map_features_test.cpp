// SPDX-License-Identifier: Apache-2.0
// Signatures of packs as the packer writes them.
#include "runtime/localize/query/map_features.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "runtime/localize/query/stored_map.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

using test_support::SignatureRecipe;

class MapFeaturesTest : public testing::Test {
 protected:
  // Room a holds the recipe's signature 1, at x 2, y 2.
  void pack(SignatureRecipe recipe) {
    recipe.x = recipe.y = 2;
    SignatureRecipe other;
    other.id = 2;
    other.x = 6;
    other.y = 2;
    test_support::SmallMap map({recipe}, {other});
    for (const auto& [name, bytes] : map.folder.files) {
      test_support::write_bytes(folder / name, bytes);
    }
    auto catalog = Catalog::open(folder.path().string(), kDefaultPayload);
    ASSERT_TRUE(catalog.ok());
    auto decoded = decode_zone(*catalog, catalog->zones[0], kDefaultPayload);
    ASSERT_TRUE(decoded.ok()) << decoded.error().message;
    pack_.emplace(std::move(*decoded));
    signatures.emplace(pack_->view());
    ASSERT_EQ(signatures->size(), 1u);
  }

  test_support::TemporaryFolder folder;
  std::optional<DecodedPack> pack_;
  std::optional<ZoneSignatures> signatures;
};

// Of 20 features every third lacks its point (2, 5, 8, 11, 14, 17), and two of the others lack a
// coordinate (6, 13): 12 are left.
TEST_F(MapFeaturesTest, AreThoseWhosePlaceIsKnown) {
  pack({});
  const auto copy = copy_features((*signatures)[0], 7, 32);
  ASSERT_TRUE(copy);
  EXPECT_EQ(copy->id, 1u);
  EXPECT_EQ(copy->zone, 7u);
  ASSERT_EQ(copy->points.size(), 12u);
  ASSERT_EQ(copy->descriptors.size(), 12u * 32);
  const FeaturesView all = (*signatures)[0].features();
  std::size_t row = 0;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (i % 3 == 2 || i % 7 == 6) continue;
    const Feature feature = all[i];
    const MapPoint& point = copy->points[row];
    EXPECT_EQ(point.x_px, feature.x_px) << i;
    EXPECT_EQ(point.y_px, feature.y_px) << i;
    EXPECT_EQ(point.x_m, feature.p_base[0]) << i;
    EXPECT_EQ(point.y_m, feature.p_base[1]) << i;
    EXPECT_EQ(point.z_m, feature.p_base[2]) << i;
    EXPECT_EQ(std::memcmp(copy->descriptors.data() + row * 32, feature.descriptor.data(), 32), 0)
        << i;
    ++row;
  }
}

// Signature 1 is turned by a quarter. Its camera sits at 0.25, 0.125, 0.5 in the base, and is
// turned by a quarter as well.
TEST_F(MapFeaturesTest, KnowWhereTheirCameraWas) {
  pack({});
  const auto copy = copy_features((*signatures)[0], 0, 32);
  ASSERT_TRUE(copy);
  EXPECT_TRUE(copy->T_map_base.translation().isApprox(Eigen::Vector3d(2, 2, 0), 1e-6));
  EXPECT_NEAR(std::atan2(copy->T_map_base(1, 0), copy->T_map_base(0, 0)), 1.5707963, 1e-6);
  EXPECT_TRUE(copy->T_base_camera.translation().isApprox(Eigen::Vector3d(0.25, 0.125, 0.5), 1e-6));
  EXPECT_NEAR(copy->T_base_camera(1, 0), 1, 1e-6);
  EXPECT_EQ(copy->fx_px, 385);
  double farthest = 0;
  for (const MapPoint& point : copy->points) {
    farthest = std::max(farthest, std::hypot(double{point.x_m} - 0.25, double{point.y_m} - 0.125,
                                             double{point.z_m} - 0.5));
  }
  EXPECT_NEAR(copy->reach_m, farthest, 1e-6);
}

TEST_F(MapFeaturesTest, KnowNoCameraWhereTheSourceStoredNoneOrAPair) {
  for (const auto camera : {SignatureRecipe::Camera::kNone, SignatureRecipe::Camera::kStereo}) {
    SignatureRecipe recipe;
    recipe.camera = camera;
    pack(recipe);
    const auto copy = copy_features((*signatures)[0], 0, 32);
    ASSERT_TRUE(copy);
    EXPECT_EQ(copy->fx_px, 0);
    EXPECT_TRUE(copy->T_base_camera.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_EQ(copy->points.size(), 12u);
  }
}

TEST_F(MapFeaturesTest, KnowTheFirstOfTwoCameras) {
  SignatureRecipe recipe;
  recipe.camera = SignatureRecipe::Camera::kTwoMono;
  pack(recipe);
  EXPECT_EQ(copy_features((*signatures)[0], 0, 32)->fx_px, 385);
}

TEST_F(MapFeaturesTest, LeaveOutDescriptorsOfAnotherLength) {
  pack({});
  const auto copy = copy_features((*signatures)[0], 0, 64);
  ASSERT_TRUE(copy);
  EXPECT_TRUE(copy->points.empty());
  EXPECT_TRUE(copy->descriptors.empty());
  EXPECT_EQ(copy->reach_m, 0);
}

// 4 bytes a number.
TEST_F(MapFeaturesTest, TakeDescriptorsOfFloats) {
  SignatureRecipe recipe;
  recipe.descriptor = packer::Features::DescriptorType::kF32;
  recipe.descriptor_dim = 16;
  pack(recipe);
  EXPECT_EQ(copy_features((*signatures)[0], 0, 64)->points.size(), 12u);
}

TEST_F(MapFeaturesTest, AreCopiedOfAllSignaturesOfAZone) {
  pack({});
  const std::vector<MapFeatures> all = copy_features(*signatures, 3, 32);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].zone, 3u);
  EXPECT_EQ(all[0].points.size(), 12u);
}

}  // namespace
}  // namespace zonepack::localize
