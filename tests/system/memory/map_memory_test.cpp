// SPDX-License-Identifier: Apache-2.0
// Compares what a map takes from the heap with what accounting.hpp charges for it.
#include <gtest/gtest.h>

#include "packer/build/manifest_writer.hpp"
#include "packer/encode/pack_writer.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/control/zone_keeper.hpp"
#include "runtime/map/loader.hpp"
#include "runtime/memory/arena.hpp"
#include "runtime/run/maps/map_demand.hpp"
#include "runtime/serve/server.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/tracker.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/memory/counted_heap.hpp"

namespace zonepack {
namespace {

using counted_heap::live_bytes;
using packer::PackSummary;

// Square rooms of 4 m in rows of 100, each with a door to the next and to the one above, with names
// of `name_bytes`, and 3 slots each.
packer::Bytes manifest_of(std::uint32_t rooms, std::size_t name_bytes) {
  constexpr std::uint32_t kRow = 100;
  packer::ZonePlan plan;
  std::vector<PackSummary> packs;
  packer::ManifestContent content;
  for (std::uint32_t i = 0; i < rooms; ++i) {
    const double x = 4.0 * (i % kRow), y = 4.0 * (i / kRow);
    packer::PlannedZone& zone = plan.zones.emplace_back();
    const std::string number = std::to_string(i);
    zone.name = "r" + std::string(6 - number.size(), '0') + number;
    zone.name.resize(std::max(name_bytes, zone.name.size()), 'x');
    zone.zone_type = "room";
    zone.polygon.outer = {{x, y}, {x + 4, y}, {x + 4, y + 4}, {x, y + 4}};
    const auto door = [&](std::uint32_t to, packer::PlannedPortal portal) {
      if (to >= rooms) return;
      portal.name = zone.name.substr(0, 7) + "-" + std::to_string(to);
      portal.zone_a = i;
      portal.zone_b = to;
      plan.portals.push_back(portal);
    };
    if ((i + 1) % kRow != 0) door(i + 1, {"", 0, 0, {{x + 4, y + 1}, {x + 4, y + 2}}});
    door(i + kRow, {"", 0, 0, {{x + 1, y + 4}, {x + 2, y + 4}}});
    PackSummary& pack = packs.emplace_back();
    pack.file = zone.name + "-0123456789abcdef.zpk";
    pack.signatures = 2;
    pack.payloads[0] = {2000, 1000, 3};
    pack.slots = {3};
    content.nodes.emplace_back(2);
  }
  content.plan = &plan;
  content.packs = &packs;
  content.payload = kCoreOnly;
  return packer::manifest_bytes(content);
}

struct NullLoader final : ZoneLoader {
  void load(const LoadRequest&) noexcept override {}
  void cancel() noexcept override {}
  void take_back(SlotChain) noexcept override {}
  void use(const Catalog&) noexcept override {}
  std::optional<LoadResult> poll() noexcept override { return std::nullopt; }
};

struct NullEvents final : EventSink {
  void on_event(const Event&) noexcept override {}
};

struct Size {
  std::uint32_t rooms;
  std::size_t name_bytes;
};

class MapMemory : public ::testing::TestWithParam<Size> {};

TEST_P(MapMemory, IsNeverMoreThanWhatIsCharged) {
  const test_support::TemporaryFolder folder;
  {
    const packer::Bytes manifest = manifest_of(GetParam().rooms, GetParam().name_bytes);
    const std::string_view text(reinterpret_cast<const char*>(manifest.data()), manifest.size());
    ASSERT_TRUE(write_file_atomically(folder / std::string(kManifestName), text).ok());
  }
  const std::string path = folder.path().string();
  const std::size_t before = live_bytes();

  const auto catalog = Catalog::open(path, kCoreOnly);
  ASSERT_TRUE(catalog.ok()) << catalog.error().message;
  ASSERT_EQ(catalog->zones.size(), GetParam().rooms);
  const ZoneGraph graph = graph_of(*catalog);
  const std::vector<ZoneNeed> needs = needs_of(*catalog);
  const std::vector<LoadWork> work = work_of(*catalog);
  const std::vector<float> load_s = load_times_of(work, LoadRates(), 10'000'000);
  const ResidencyLimits limits = limits_for(*catalog, std::nullopt, 0, {});
  Residency memory(needs.size(), limits);
  const SlotPool pool(memory.slot_count());
  NullLoader loader;
  NullEvents events;
  EventStamper stamper(events);
  const ZoneKeeper keeper(memory, loader, stamper, needs, {});
  const ZoneTracker tracker(graph);
  const Preload preload(graph, load_s);
  const ZoneTable served(needs.size());
  const Result<NodeStore> nodes = NodeStore::open(*catalog);
  ASSERT_TRUE(nodes.ok());

  const std::size_t taken = live_bytes() - before + sizeof graph + sizeof memory + sizeof keeper +
                            sizeof tracker + sizeof preload;
  const ByteCount for_loads = kReadBufferBytes + kIndexBytesPerPack + 3 * kIndexBytesPerChunk;
  const ByteCount charged = charged_with(catalog->fixed_bytes, pool.slot_count()) -
                            pool.slot_count() * kSlotBytes - for_loads;
  EXPECT_LE(taken, charged);
  // And the charge is not far too high: at least a third of it is really used.
  EXPECT_GE(taken * 3, charged);
  std::printf("%u zones, names of %zu bytes: %zu bytes taken of %llu charged, %.0f a zone\n",
              GetParam().rooms, GetParam().name_bytes, taken,
              static_cast<unsigned long long>(charged),
              static_cast<double>(taken) / GetParam().rooms);
}

INSTANTIATE_TEST_SUITE_P(Rooms, MapMemory,
                         ::testing::Values(Size{10, 7}, Size{10, 64}, Size{1000, 7}, Size{1000, 64},
                                           Size{1025, 40}, Size{100'000, 7}, Size{100'000, 64}));

TEST(LoadMemory, IsNeverMoreThanWhatIsCharged) {
  const test_support::TemporaryFolder folder;
  packer::PackWriter writer(folder.path(), "hall");
  for (std::int32_t id = 1; id <= 400; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.features = 300;
    packer::SignatureRecord record = test_support::make_signature(recipe);
    writer.add(record, 0, 0);
  }
  Catalog catalog;
  catalog.folder = folder.path().string();
  catalog.payload = kEveryPayload;
  {
    const PackSummary pack = writer.finish(kEveryPayload);
    CatalogZone& zone = catalog.zones.emplace_back();
    zone.name = "hall";
    zone.pack = pack.file;
    zone.pack_digest = pack.digest;
    zone.signatures = pack.signatures;
    zone.slots = pack.slots.back();
    for (const PackSummary::Payload& payload : pack.payloads) zone.chunks += payload.chunks;
  }
  Arena arena(catalog.zones[0].slots, kSlotBytes);
  std::vector<std::byte*> slots;
  for (SlotIndex i = 0; i < catalog.zones[0].slots; ++i) slots.push_back(arena.slot(i).data());
  std::vector<std::byte> buffer(kReadBufferBytes);

  const std::size_t before = live_bytes();
  std::size_t most = 0;
  std::size_t chunks = 0;
  {
    Result<ZoneLoad> load = ZoneLoad::begin(catalog, 0, slots, buffer);
    ASSERT_TRUE(load.ok()) << to_string(load.error().code);
    most = live_bytes() - before;
    const std::size_t allocations = counted_heap::allocations();
    for (;;) {
      const Result<bool> more = load->step();
      ASSERT_TRUE(more.ok());
      if (!*more) break;
      most = std::max(most, live_bytes() - before);
    }
    EXPECT_EQ(counted_heap::allocations(), allocations) << "a step allocates";
    chunks = load->chunks().size();
  }
  ASSERT_GT(chunks, 100u);
  EXPECT_EQ(live_bytes(), before);
  EXPECT_LE(most, kIndexBytesPerPack + chunks * kIndexBytesPerChunk);
  std::printf("%zu chunks: %zu bytes taken of %llu charged\n", chunks, most,
              static_cast<unsigned long long>(kIndexBytesPerPack + chunks * kIndexBytesPerChunk));
}

}  // namespace
}  // namespace zonepack
