// SPDX-License-Identifier: Apache-2.0
// A change of map as clients see it.
#include <gtest/gtest.h>

#include "runtime/serve/server.hpp"
#include "tests/unit/runtime/serve/served.hpp"

namespace zonepack {
namespace {

using testing_support::Client;
using testing_support::Served;
using testing_support::Serving;
using testing_support::soon;
using wire::Fault;

TEST_F(Served, AChangeOfMapIsAnnouncedAndOldZoneNumbersAreRefused) {
  ASSERT_TRUE(run.open());
  Catalog other = testing_support::three_room_catalog();
  other.zones[0].name = "A";
  run.server->offer_map(5, other, run.graph, {});
  const Serving serving(run);
  std::uint32_t told = 0;
  Client client(run.settings.socket);
  client.connection().on_notice([&](const wire::Reply& notice) {
    if (const auto* change = notice.body_as_MapChanged()) told = change->map_serial();
  });
  const std::uint32_t serial = client.connection().welcome().map_serial();
  const auto ask = [&](std::uint32_t map) -> const wire::Reply& {
    return client.ask([](auto& b) { return wire::CreateAskZone(b, 0); }, {}, map);
  };
  EXPECT_EQ(ask(serial).body_as_Zone()->name()->str(), "a");
  run.map = 5;
  run.happen(EventKind::kMapChanged, kNoZone);
  run.load(0, 9);  // of the new map
  ASSERT_TRUE(soon([&] { return ask(0).body_as_Zone()->name()->str() == "A"; }));
  EXPECT_EQ(ask(0).body_as_Zone()->generation(), 9u);
  EXPECT_EQ(told, 5u);
  const wire::Status& status = client.status();
  EXPECT_EQ(status.map_serial(), 5u);
  EXPECT_EQ(status.map_changes_total(), 1u);
  EXPECT_EQ(ask(serial).fault(), Fault::StaleMap);
  EXPECT_EQ(ask(told).fault(), Fault::None);
}

TEST_F(Served, AnotherMapIsServedEvenWhenItsEventWasLost) {
  ASSERT_TRUE(run.open());
  Catalog other = testing_support::three_room_catalog();
  other.zones[0].name = "A";
  run.server->offer_map(2, other, run.graph, {});
  const Serving serving(run);
  Client client(run.settings.socket);
  const auto ask = [&]() -> const wire::Reply& {
    return client.ask([](auto& b) { return wire::CreateAskZone(b, 0); });
  };
  run.map = 7;  // of a map that it does not know: skipped
  run.load(0, 3);
  run.map = 2;
  run.load(0, 9);
  ASSERT_TRUE(soon([&] { return ask().body_as_Zone()->name()->str() == "A"; }));
  EXPECT_EQ(ask().body_as_Zone()->generation(), 9u);
}

TEST_F(Served, AMapThatIsNotUsedAnyMoreIsForgottenWithoutAnyEvent) {
  ASSERT_TRUE(run.open());
  Catalog other = testing_support::three_room_catalog();
  run.server->offer_map(2, other, run.graph, {});
  run.server->forget_map(2);  // refused
  EXPECT_EQ(run.server->map().serial, 1u);
  run.server->offer_map(3, other, run.graph, {});
  run.server->forget_map(1);  // changed
  EXPECT_EQ(run.server->map().serial, 3u);
  EXPECT_EQ(&run.server->map().catalog, &other);
}

}  // namespace
}  // namespace zonepack
