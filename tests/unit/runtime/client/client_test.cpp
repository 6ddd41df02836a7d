// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/client.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "packer/encode/pack_writer.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/client/fake_zoned.hpp"

namespace zonepack {
namespace {

// A zone's worth of chunks.
DecodedPack some_zone() {
  const test_support::TemporaryFolder folder;
  packer::PackWriter writer(folder.path(), "zone");
  test_support::SignatureRecipe recipe;
  recipe.id = 1;
  packer::SignatureRecord record = test_support::make_signature(recipe);
  writer.add(record, 0, 0);
  const auto reader = PackReader::open(folder / writer.finish(kEveryPayload).file);
  return DecodedPack::decode(*reader, kEveryPayload).value();
}

class Connected : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
  const std::string path = folder / "zoned.sock";
  SharedMemory memory = SharedMemory::create("zonepack-test", shared_map_bytes(2, 4)).value();
  test_support::SharedZones zones{memory.bytes(), 2, 4};
  std::optional<test_support::FakeZoned> zoned{std::in_place, path, memory};
  Client client = Client::connect(path, "client_test").value();
};

TEST_F(Connected, FindsZonesByTheirNames) {
  EXPECT_EQ(client.find_zone("lobby").value(), 1u);
  EXPECT_EQ(client.find_zone("cellar").error().code, ErrorCode::kNotFound);
  ASSERT_EQ(client.zones()->size(), 2u);
  EXPECT_EQ((*client.zones())[0].name, "corridor");
  EXPECT_EQ((*client.zones())[0].signatures, 5u);
}

TEST_F(Connected, ReadsTheMemoryItWasHanded) {
  EXPECT_EQ(client.reader().zone_count(), 2u);
  EXPECT_EQ(client.read(1, [](const ZoneSignatures&) {}), ReadStatus::kAbsent);
}

TEST_F(Connected, LooksUpNamesAgainWhenTheMapChanged) {
  ASSERT_EQ(client.find_zone("lobby").value(), 1u);
  zoned->change_map(2, {"lobby", "ward"});
  // The change arrives with the next answer, which refuses a number of the old map.
  EXPECT_EQ(client.lease(1).error().code, ErrorCode::kMismatch);
  EXPECT_EQ(client.find_zone("lobby").value(), 0u);
  EXPECT_TRUE(client.lease(0).ok());
}

TEST_F(Connected, ReadsNothingByANumberOfTheMapBefore) {
  zoned->epoch = zones.map().epoch();
  ASSERT_TRUE(client.zones());  // this zoned was of a version that did not report it until now
  const DecodedPack pack = some_zone();
  zones.put(1, pack.chunks());
  int reads = 0;
  const auto read = [&] { return client.read(1, [&](const ZoneSignatures&) { ++reads; }); };
  EXPECT_EQ(read(), ReadStatus::kOk);
  zones.remove(1);
  ASSERT_TRUE(zones.map().begin_map(2));
  zones.put(1, pack.chunks());
  EXPECT_EQ(read(), ReadStatus::kAbsent);  // the number may be another zone's now
  ASSERT_TRUE(client.zones());
  EXPECT_EQ(read(), ReadStatus::kAbsent);  // the server has not seen the change yet
  ++zoned->epoch;
  ASSERT_TRUE(client.zones());
  EXPECT_EQ(read(), ReadStatus::kOk);
  EXPECT_EQ(reads, 2);
}

TEST_F(Connected, TakesAndReleasesLeases) {
  const auto lease = client.lease(1);
  ASSERT_TRUE(lease.ok());
  EXPECT_EQ(lease->zone, 1u);
  EXPECT_EQ(lease->lasts_ns, 9'000'000);
  EXPECT_TRUE(client.release(*lease).ok());
  EXPECT_EQ(zoned->released, 7u);
}

TEST_F(Connected, AsksForThePoseAndGivesOne) {
  const auto pose = client.pose();
  ASSERT_TRUE(pose.ok());
  EXPECT_EQ(pose->pose.y, 2);
  EXPECT_EQ(pose->pose.covariance, (std::array<double, 6>{0.1, 0, 0, 0.2, 0, 0.3}));
  EXPECT_EQ(pose->stamp_ns, 42);
  EXPECT_TRUE(client.give_pose({1, 2, 3, {}}, 55).ok());
  EXPECT_EQ(zoned->pose_stamp_ns, 55);
}

TEST_F(Connected, AsksForTheNearestSignatures) {
  const auto near = client.nearest(1, 2, 10, 1);
  ASSERT_TRUE(near.ok());
  ASSERT_EQ(near->size(), 1u);
  EXPECT_EQ(near->front().id, 17);
  EXPECT_EQ(near->front().distance_m, 0.25F);
}

TEST_F(Connected, ReportsWhyZonedRefuses) {
  zoned->fault = wire::Fault::Denied;
  EXPECT_EQ(client.pose().error(), (Error{ErrorCode::kIo, EACCES}));
  EXPECT_EQ(client.last_words(), "because of the test");
  zoned->fault = wire::Fault::NoRoom;
  EXPECT_EQ(client.lease(0).error().code, ErrorCode::kNoRoom);
}

TEST_F(Connected, WaitsForTheAnswerThroughSignals) {
  struct sigaction handler {};
  handler.sa_handler = [](int) {};  // without SA_RESTART: system calls end with EINTR
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGUSR1, &handler, &before), 0);
  zoned->answers_after_ms = 100;
  std::thread disturber([waiting = pthread_self()] {
    for (int i = 0; i < 5; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      pthread_kill(waiting, SIGUSR1);
    }
  });
  EXPECT_TRUE(client.pose().ok());
  disturber.join();
  sigaction(SIGUSR1, &before, nullptr);
}

TEST_F(Connected, GoesOnReadingButSaysThatZonedIsGone) {
  zoned.reset();
  EXPECT_EQ(client.pose().error().code, ErrorCode::kCancelled);
  EXPECT_EQ(client.read(1, [](const ZoneSignatures&) {}), ReadStatus::kAbsent);
}

TEST(Connecting, SaysThatNobodyIsThere) {
  EXPECT_EQ(Client::connect("/nonexistent/zoned.sock", "x").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace zonepack
