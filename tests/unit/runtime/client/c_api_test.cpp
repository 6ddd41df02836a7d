// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "packer/decode/record_decoder.hpp"
#include "packer/encode/pack_writer.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/client/c_reader.h"
#include "tests/unit/runtime/client/fake_zoned.hpp"

namespace zonepack {
namespace {

using test_support::SharedZones;

DecodedPack three_signatures() {
  const test_support::TemporaryFolder folder;
  packer::PackWriter writer(folder.path(), "zone");
  for (std::int32_t id = 1; id <= 3; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.label = "door";
    recipe.neighbours = {id + 1};
    packer::SignatureRecord record = test_support::make_signature(recipe);
    writer.add(record, 0, 0);
  }
  const auto reader = PackReader::open(folder / writer.finish(kEveryPayload).file);
  return DecodedPack::decode(*reader, kEveryPayload).value();
}

// What c_reader.c adds up, from the packer's side.
c_totals expected_totals(const ZoneView& zone) {
  c_totals t{};
  t.signatures = zone.size();
  for (std::uint32_t i = 0; i < zone.size(); ++i) {
    const packer::SignatureRecord r = packer::decode_record(zone, i);
    t.sum_of_ids += r.id;
    t.label_bytes += r.label.size();
    t.features += static_cast<std::uint32_t>(r.features.count);
    for (const float x : r.features.x) t.sum_of_x += static_cast<double>(x);
    for (const std::int32_t word : r.features.word_id) t.sum_of_words += word;
    t.descriptor_bytes += r.features.descriptors.size();
    t.links += static_cast<std::uint32_t>(r.links.size());
    // Format 1: two floats a point; cells have two floats too.
    t.scan_points += static_cast<std::uint32_t>(r.scan->data.data.size() / 8);
    for (const auto* cells : {&r.grid->ground, &r.grid->obstacle, &r.grid->empty}) {
      if (*cells) t.cells += static_cast<std::uint32_t>((*cells)->data.size() / 8);
    }
    t.image_bytes += r.image.size();
  }
  return t;
}

class FromC : public testing::Test {
 protected:
  const DecodedPack pack = three_signatures();
  const std::uint32_t slots = SharedZones::slots_for(pack.chunks());
  SharedMemory memory = SharedMemory::create("zonepack-test", shared_map_bytes(2, slots)).value();
  SharedZones zones{memory.bytes(), 2, slots};
  c_totals totals{};
};

TEST_F(FromC, AZoneIsReadAsThePackerHasIt) {
  zones.put(1, pack.chunks());
  zp_status status = ZP_DAMAGED;
  zp_client* const client =
      zp_open_memory(memory.read_only().data(), memory.read_only().size(), &status);
  ASSERT_EQ(status, ZP_OK);
  EXPECT_EQ(zp_zone_count(client), 2u);
  EXPECT_EQ(c_read_zone(client, 0, &totals), ZP_ABSENT);
  EXPECT_EQ(c_read_zone(client, 1, &totals), ZP_OK);
  const c_totals expected = expected_totals(pack.view());
  EXPECT_EQ(totals.signatures, 3u);
  EXPECT_EQ(totals.sum_of_ids, 6);
  EXPECT_EQ(totals.label_bytes, 12u);
  EXPECT_EQ(totals.features, expected.features);
  EXPECT_EQ(totals.sum_of_x, expected.sum_of_x);
  EXPECT_EQ(totals.sum_of_words, expected.sum_of_words);
  EXPECT_EQ(totals.descriptor_bytes, expected.descriptor_bytes);
  EXPECT_EQ(totals.links, expected.links);
  EXPECT_EQ(totals.scan_points, expected.scan_points);
  EXPECT_EQ(totals.cells, expected.cells);
  EXPECT_EQ(totals.image_bytes, expected.image_bytes);
  zp_close(client);
}

TEST_F(FromC, MemoryOfSomethingElseIsRefused) {
  alignas(64) const std::array<std::byte, 4096> other{};
  zp_status status = ZP_OK;
  EXPECT_EQ(zp_open_memory(other.data(), other.size(), &status), nullptr);
  EXPECT_EQ(status, ZP_DAMAGED);
}

TEST_F(FromC, TheSocketIsUsedAsFromCxx) {
  const test_support::TemporaryFolder folder;
  const std::string path = folder / "zoned.sock";
  const test_support::FakeZoned zoned(path, memory);
  zp_status status = ZP_DAMAGED;
  zp_client* const client = zp_connect(path.c_str(), "c_api_test", 2000, &status);
  ASSERT_EQ(status, ZP_OK);
  uint32_t zone = 9;
  EXPECT_EQ(zp_find_zone(client, "lobby", &zone), ZP_OK);
  EXPECT_EQ(zone, 1u);
  EXPECT_EQ(zp_find_zone(client, "cellar", &zone), ZP_ABSENT);
  zp_lease lease;
  EXPECT_EQ(zp_take_lease(client, 1, &lease), ZP_OK);
  EXPECT_EQ(zp_release(client, &lease), ZP_OK);
  const double covariance[6] = {0.01, 0, 0, 0.01, 0, 0.01};
  EXPECT_EQ(zp_give_pose(client, 1, 2, 3, covariance, 77), ZP_OK);
  EXPECT_EQ(zoned.pose_stamp_ns, 77);
  zp_close(client);
  EXPECT_EQ(zp_connect("/nonexistent/sock", "x", 100, &status), nullptr);
  EXPECT_EQ(status, ZP_NO_SERVER);
}

}  // namespace
}  // namespace zonepack
