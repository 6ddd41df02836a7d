// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/pack_filler.hpp"

#include "runtime/map/load_fault.hpp"
#include "runtime/map/loader.hpp"

namespace zonepack {

PackFiller::PackFiller(const Catalog& catalog, std::uint32_t slots)
    : catalog_(&catalog),
      arena_(slots, kSlotBytes),
      read_buffer_(kReadBufferBytes),
      chunks_(catalog.zones.size()),
      noted_(catalog.zones.size()) {
  places_.reserve(slots);
}

Result<void> PackFiller::fill(ZoneId zone, std::span<const SlotIndex> slots) {
  places_.clear();
  for (const SlotIndex slot : slots) places_.push_back(arena_.slot(slot).data());
  const Result<void> loaded = load(zone);
  if (!loaded) note(zone, loaded.error());
  return loaded;
}

void PackFiller::use(const Catalog& catalog) {
  if (&catalog == catalog_) return;
  // Zones with the same pack may be kept through a change of map.
  std::vector<std::vector<ChunkRef>> chunks(catalog.zones.size());
  for (ZoneId zone = 0; zone < catalog.zones.size(); ++zone) {
    const ZoneId before = catalog_->find(catalog.zones[zone].name);
    if (before == kNoZone ||
        catalog_->zones[before].pack_digest != catalog.zones[zone].pack_digest) {
      continue;
    }
    chunks[zone] = std::move(chunks_[before]);
  }
  catalog_ = &catalog;
  chunks_ = std::move(chunks);
  noted_.assign(catalog.zones.size(), false);
}

Result<void> PackFiller::load(ZoneId zone) {
  Result<ZoneLoad> load =
      ZoneLoad::begin(*catalog_, zone, places_, read_buffer_, ReadMode::kCached);
  if (!load) return load.error();
  for (;;) {
    const Result<bool> more = load->step();
    if (!more) return more.error();
    if (!*more) {
      chunks_[zone] = load->chunks();
      return {};
    }
  }
}

void PackFiller::note(ZoneId zone, Error error) {
  if (noted_[zone]) return;
  noted_[zone] = true;
  faults_.push_back(load_fault(*catalog_, zone, error));
}

}  // namespace zonepack
