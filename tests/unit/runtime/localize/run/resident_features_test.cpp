// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/resident_features.hpp"

#include <gtest/gtest.h>

#include <map>

#include "runtime/localize/query/localizer.hpp"
#include "tests/support/decoded_database.hpp"

namespace zonepack::localize {
namespace {

// The sample map's signatures in one pack, decoded.
const DecodedPack& sample() {
  static const DecodedPack decoded =
      test_support::decoded_database(std::string(ZONEPACK_TEST_DATA) + "/hospital-small.db");
  return decoded;
}

// Zones as a test makes them come and go.
class FakeZones final : public ZonesInMemory {
 public:
  std::uint32_t now_epoch = 1;
  std::map<ZoneId, bool> here = {{0, false}, {1, true}};
  int reads = 0, holds = 0;
  int expiring = 0;  // reads from now on whose zone is unloaded meanwhile

  std::uint32_t epoch() const noexcept override { return now_epoch; }
  std::uint32_t zones() const noexcept override { return 2; }
  bool resident(ZoneId zone) const noexcept override { return here.at(zone); }
  ReadStatus read(ZoneId, const Fn& fn) override {
    ++reads;
    fn(ZoneSignatures(sample().view()));
    return expiring-- > 0 ? ReadStatus::kExpired : ReadStatus::kOk;
  }
  void hold(ZoneId, const std::function<void()>& fn) override {
    ++holds;
    fn();
  }
};

class Resident : public testing::Test {
 protected:
  // Where the map's signature `index` is.
  static QueryPrior at(std::uint32_t index) {
    const auto pose = *ZoneSignatures(sample().view())[index].T_map_base();
    QueryPrior prior;
    prior.T_map_base = {static_cast<double>(pose[3]), static_cast<double>(pose[7]), 0};
    prior.covariance.xx = prior.covariance.yy = 0.01;
    prior.covariance.yaw_yaw = 0.01;
    return prior;
  }
  static QueryPrior far_away() {
    QueryPrior prior = at(0);
    prior.T_map_base.x_m += 1000;
    return prior;
  }

  FakeZones zones;
  ResidentFeatures features{32};
};

// Those in reach and no others, as copy_features() gives them.
TEST_F(Resident, AreTheSignaturesInReach) {
  const QueryPrior prior = at(0);
  const auto near = features.near(zones, prior);
  std::size_t expected = 0;
  const ZoneSignatures all(sample().view());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const auto copy = copy_features(all[i], 1, 32);
    if (!copy || !in_reach(copy->T_map_base, prior)) continue;
    ASSERT_LT(expected, near.size());
    EXPECT_EQ(near[expected]->id, copy->id);
    EXPECT_EQ(near[expected]->zone, 1U);
    EXPECT_EQ(near[expected]->descriptors, copy->descriptors);
    ++expected;
  }
  EXPECT_EQ(near.size(), expected);
  EXPECT_GT(expected, 0U);
  EXPECT_LT(expected, all.size());
}

TEST_F(Resident, AreCopiedOnce) {
  const std::size_t count = features.near(zones, at(0)).size();
  const int reads = zones.reads;
  EXPECT_EQ(features.near(zones, at(0)).size(), count);
  EXPECT_EQ(zones.reads, reads);
}

TEST_F(Resident, AreForgottenWhenTheRobotLeaves) {
  features.near(zones, at(0));
  EXPECT_GT(features.signatures_held(), 0U);
  EXPECT_TRUE(features.near(zones, far_away()).empty());
  EXPECT_EQ(features.signatures_held(), 0U);
}

TEST_F(Resident, AreForgottenWhenTheirZoneIsUnloaded) {
  features.near(zones, at(0));
  zones.here[1] = false;
  EXPECT_TRUE(features.near(zones, at(0)).empty());
  EXPECT_EQ(features.signatures_held(), 0U);
}

TEST_F(Resident, AreReadAgainAfterAChangeOfMap) {
  features.near(zones, at(0));
  const int reads = zones.reads;
  zones.now_epoch = 2;
  EXPECT_FALSE(features.near(zones, at(0)).empty());
  EXPECT_GT(zones.reads, reads);
}

// What was read of a zone that was unloaded meanwhile counts for nothing. The next try holds it.
TEST_F(Resident, AreNotTakenFromAZoneThatIsUnloadedMeanwhile) {
  features.near(zones, far_away());  // lists the zone
  zones.expiring = 1;
  EXPECT_TRUE(features.near(zones, at(0)).empty());
  EXPECT_EQ(features.expired(), 1U);
  EXPECT_EQ(zones.holds, 0);
  EXPECT_FALSE(features.near(zones, at(0)).empty());
  EXPECT_EQ(zones.holds, 1);
}

TEST_F(Resident, AreNotListedFromAZoneThatIsUnloadedMeanwhile) {
  zones.expiring = 1;
  EXPECT_TRUE(features.near(zones, at(0)).empty());
  EXPECT_FALSE(features.near(zones, at(0)).empty());
}

}  // namespace
}  // namespace zonepack::localize
