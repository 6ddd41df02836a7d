// SPDX-License-Identifier: Apache-2.0
// Opens a map, loads its first zone and says how much it holds.
#include <cstdio>
#include <vector>
#include <zonepack/runtime/map/catalog.hpp>
#include <zonepack/runtime/map/loader.hpp>
#ifdef WITH_PACKER
#include <zonepack/packer/zones/zone_file.hpp>
#endif

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto catalog = zonepack::Catalog::open(argv[1], zonepack::kDefaultPayload);
  if (!catalog || catalog->zones.empty()) return 1;
  std::vector<std::byte> memory((catalog->zones[0].slots + 1) * zonepack::kSlotBytes);
  auto* const aligned = reinterpret_cast<std::byte*>(
      (reinterpret_cast<std::uintptr_t>(memory.data()) + 63) / 64 * 64);
  std::vector<std::byte*> slots;
  for (std::uint32_t i = 0; i < catalog->zones[0].slots; ++i) {
    slots.push_back(aligned + i * zonepack::kSlotBytes);
  }
  std::vector<std::byte> buffer(zonepack::kReadBufferBytes);
  auto load = zonepack::ZoneLoad::begin(*catalog, 0, slots, buffer);
  if (!load) return 1;
  for (;;) {
    const auto more = load->step();
    if (!more) return 1;
    if (!*more) break;
  }
  const auto view = zonepack::ZoneView::make(load->chunks());
  if (!view) return 1;
  std::printf("%s %u\n", catalog->zones[0].name.c_str(), view->size());
#ifdef WITH_PACKER
  if (zonepack::packer::find_name_problem("L1")) return 1;
#endif
  return 0;
}
