// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/map/catalog.hpp"
#include "runtime/memory/arena.hpp"
#include "runtime/pack_format/zone_view.hpp"
#include "runtime/run/maps/modelled_loader.hpp"

namespace zonepack {

// Loads zones from their packs into an arena, as the robot does, so that damage shows.
class PackFiller final : public ZoneFiller {
 public:
  // The catalog must outlive its use.
  PackFiller(const Catalog& catalog, std::uint32_t slots);

  Result<void> fill(ZoneId zone, std::span<const SlotIndex> slots) override;
  void use(const Catalog& catalog) override;

  // Where the chunks of a zone lie in the arena since it was last loaded; until others use its
  // slots.
  const std::vector<ChunkRef>& chunks(ZoneId zone) const noexcept { return chunks_[zone]; }

  // A complete message for each zone whose pack could not be loaded, once.
  const std::vector<std::string>& faults() const noexcept { return faults_; }

 private:
  Result<void> load(ZoneId zone);
  void note(ZoneId zone, Error error);

  const Catalog* catalog_;
  Arena arena_;
  std::vector<std::byte> read_buffer_;
  std::vector<std::byte*> places_;
  std::vector<std::vector<ChunkRef>> chunks_;  // by ZoneId
  std::vector<bool> noted_;
  std::vector<std::string> faults_;
};

}  // namespace zonepack
