// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/drive_account.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace zonepack {
namespace {

// Zones A to D of 1000 stored bytes, read at 1000 bytes/s: a load takes a second.
class Account : public testing::Test {
 protected:
  Account() {
    Catalog catalog;
    for (const char* const name : {"A", "B", "C", "D"}) {
      CatalogZone zone;
      zone.name = name;
      zone.slots = 1;
      zone.signatures = 10;
      zone.stored_bytes = 1000;
      catalog.zones.push_back(zone);
    }
    auto made = MapVersion::make(1, std::move(catalog), {.budget = 10 * kMiB, .rates = rates});
    if (made) map = *made;
    account = std::make_unique<DriveAccount>(map->model(), rates);
  }

  // A word each: eA entered, wA wanted, uA unwanted, bA load begins, lA loaded, gA given up, xA
  // evicted; 400 ms pass before each.
  void happen(const std::string& words) {
    static const std::vector<std::pair<char, EventKind>> kKinds = {
        {'e', EventKind::kZoneEntered},  {'w', EventKind::kZoneWanted},
        {'u', EventKind::kZoneUnwanted}, {'b', EventKind::kLoadStarted},
        {'l', EventKind::kLoadDone},     {'g', EventKind::kLoadGivenUp},
        {'x', EventKind::kEvicted}};
    for (std::size_t i = 0; i + 1 < words.size(); i += 3) {
      Event event;
      for (const auto& [letter, kind] : kKinds) {
        if (letter == words[i]) event.kind = kind;
      }
      event.zone = static_cast<ZoneId>(words[i + 1] - 'A');
      event.t_ns = t_ns += 400'000'000;
      account->on_event(event, *map);
    }
  }

  std::string steps() const {
    std::string text;
    for (const auto& step : account->steps().steps) {
      text += text.empty() ? "" : " ";
      for (const ZoneId zone : step) text += static_cast<char>('A' + zone);
    }
    return text;
  }

  const LoadRates rates{.storage = 1000, .decode = 1'000'000};
  std::shared_ptr<MapVersion> map;
  std::unique_ptr<DriveAccount> account;
  std::int64_t t_ns = 0;
};

TEST_F(Account, CountsRequestsAndThoseThatFindTheZoneInMemory) {
  happen("wA bA lA uA wA wB bB lB uA");
  EXPECT_EQ(account->requests(), 3u);
  EXPECT_EQ(account->hits(), 1u);
}

TEST_F(Account, EndsAStepWhereAZoneIsNoLongerHeldAndWanted) {
  // A and B are held together, then B and C; D was never loaded; A at the end.
  happen("wA bA lA wB bB lB uA wC bC lC wD uD uB uC wA");
  account->end();
  EXPECT_EQ(steps(), "AB BC A");
}

TEST_F(Account, LeavesOutLoadsThatWereGivenUp) {
  happen("wA bA lA wB bB uA gB uB wC bC");
  account->end();
  // B was charged next to A, and C was still being loaded at the end: neither is asked of others.
  EXPECT_EQ(steps(), "A");
}

TEST_F(Account, CallsReadsUselessThatTheRobotNeverNeeded) {
  happen("eA wA bA lA wB bB lB uB xB");
  EXPECT_EQ(account->bytes_read(), 2000u);
  EXPECT_EQ(account->bytes_unused(), 1000u);
  // 400 of the 1000 ms that a load takes: 400 bytes.
  happen("wC bC gC");
  EXPECT_EQ(account->bytes_read(), 2400u);
  EXPECT_EQ(account->bytes_unused(), 1400u);
  // D is still there at the end and was never entered; A was.
  happen("wD bD lD");
  account->end();
  EXPECT_EQ(account->bytes_unused(), 2400u);
}

TEST_F(Account, CallsAReadUsefulOnceTheRobotIsInTheZone) {
  happen("eA wA bA lA wB bB lB eB uA xA");
  account->end();
  EXPECT_EQ(account->bytes_unused(), 0u);
  EXPECT_EQ(account->entered(), 2u);
}

TEST_F(Account, JudgesWhatBecameWantedAheadInTheZoneBefore) {
  // A to B: first. B to D: C came before D, so among the first two. D to A: only C was ahead.
  happen("eA wA wB eB uA wC wD eD uB uC eA");
  const auto& foreseen = account->foreseen();
  EXPECT_EQ(foreseen.changes, 3u);
  EXPECT_EQ(foreseen.first, 1u);
  EXPECT_EQ(foreseen.first_two, 2u);
}

TEST_F(Account, CountsZonesFartherAheadThatAreWantedAlready) {
  // C is wanted beyond B before the robot enters B.
  happen("eA wA wB wC eB eC");
  EXPECT_EQ(account->foreseen().first, 2u);
}

}  // namespace
}  // namespace zonepack
