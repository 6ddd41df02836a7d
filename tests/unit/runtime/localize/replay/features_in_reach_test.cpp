// SPDX-License-Identifier: Apache-2.0
// Two rooms whose packs are loaded into slots, as a replay does.
#include "runtime/localize/replay/features_in_reach.hpp"

#include <gtest/gtest.h>

#include "runtime/map/catalog.hpp"
#include "runtime/replay/pack_filler.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

class FeaturesInReachTest : public testing::Test {
 protected:
  FeaturesInReachTest() {
    test_support::SignatureRecipe in_a, in_b;
    in_a.x = 2;
    in_a.y = 2;
    in_b.id = 2;
    in_b.x = 6;
    in_b.y = 2;
    test_support::SmallMap map({in_a}, {in_b});
    map.write_manifest();
    for (const auto& [name, bytes] : map.folder.files) {
      test_support::write_bytes(folder / name, bytes);
    }
    catalog = *Catalog::open(folder.path().string(), kDefaultPayload);
    filler.emplace(catalog, catalog.zones[0].slots + catalog.zones[1].slots);
    resident.emplace(&*filler);
  }

  // Into the slots from `first` on.
  void load(ZoneId zone, std::uint32_t generation, SlotIndex first) {
    std::vector<SlotIndex> slots;
    for (std::uint32_t i = 0; i < catalog.zones[zone].slots; ++i) slots.push_back(first + i);
    ASSERT_TRUE(filler->fill(zone, slots));
    resident->publish(zone, generation, {});
  }

  std::vector<ZoneId> zones_offered(double x_m) {
    QueryPrior prior;
    prior.T_map_base = {x_m, 2, 0};
    std::vector<ZoneId> out;
    for (const MapFeatures* const one : features.in_reach_of(prior, *resident)) {
      EXPECT_FALSE(one->points.empty());
      out.push_back(one->zone);
    }
    return out;
  }

  test_support::TemporaryFolder folder;
  Catalog catalog;
  std::optional<PackFiller> filler;
  std::optional<ResidentZones> resident;
  FeaturesInReach features{32};
};

TEST_F(FeaturesInReachTest, OffersNothingOfAZoneThatIsNotResident) {
  EXPECT_TRUE(zones_offered(4).empty());
  load(0, 1, 0);
  EXPECT_EQ(zones_offered(4), std::vector<ZoneId>{0});
  load(1, 1, catalog.zones[0].slots);
  EXPECT_EQ(zones_offered(4), (std::vector<ZoneId>{0, 1}));
  resident->withdraw(0);
  EXPECT_EQ(zones_offered(4), std::vector<ZoneId>{1});
  resident->withdraw(1);
  EXPECT_TRUE(zones_offered(4).empty());
}

TEST_F(FeaturesInReachTest, ForgetsCopiesOfAZoneWhoseSlotsAreReused) {
  load(0, 1, 0);
  zones_offered(4);
  resident->withdraw(0);
  load(1, 1, 0);
  EXPECT_EQ(zones_offered(4), std::vector<ZoneId>{1});
}

TEST_F(FeaturesInReachTest, LeavesOutWhatIsBeyondTheReachOfACamera) {
  load(0, 1, 0);
  EXPECT_EQ(zones_offered(4).size(), 1u);
  EXPECT_TRUE(zones_offered(1000).empty());
}

}  // namespace
}  // namespace zonepack::localize
