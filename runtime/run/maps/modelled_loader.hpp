// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "runtime/control/zone_loader.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/memory/slot_pool.hpp"

namespace zonepack {

// Puts a zone's signatures into slots, at once.
class ZoneFiller {
 public:
  virtual ~ZoneFiller() = default;
  virtual Result<void> fill(ZoneId zone, std::span<const SlotIndex> slots) = 0;
  // Zones are of this map from here on.
  virtual void use(const Catalog&) {}
};

// What a load of a zone moves.
struct LoadWork {
  ByteCount stored_bytes = 0;   // read from storage
  ByteCount decoded_bytes = 0;  // written into slots
};

// Bytes per second. Each at least 1 and at most 10^12.
struct LoadRates {
  std::uint64_t storage = 50'000'000;
  std::uint64_t decode = 500'000'000;
};

std::vector<LoadWork> work_of(const Catalog& catalog);

// Time for one piece of work after the other: stored / storage + decoded / decode, each rounded
// down.
std::int64_t load_time_ns(const LoadWork& work, const LoadRates& rates) noexcept;

// The loader of a replay: when a load is done is calculated from its bytes. Nothing is measured, so
// every machine gives the same run. A cancelled load ends at its next chunk.
class ModelledLoader final : public ZoneLoader {
 public:
  // Zones are really loaded, by the filler, into so many slots; without one (null) slots are only
  // accounted for.
  ModelledLoader(const Catalog& catalog, std::uint32_t slots, const LoadRates& rates,
                 ZoneFiller* filler);

  // The same with the work of every zone given, by ZoneId, whichever map is used.
  ModelledLoader(std::uint32_t slots, std::vector<LoadWork> work, const LoadRates& rates,
                 ZoneFiller* filler);

  // There are no slots, and chains only count: of a run that went on before this loader was there,
  // so that nobody knows which slots its zones had. A cancelled load ends at once.
  ModelledLoader(const Catalog& catalog, const LoadRates& rates);

  // Results up to now_ns may be polled from here on. Loads start, and are cancelled, at this time.
  void advance_to(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }

  void load(const LoadRequest& request) noexcept override;
  void cancel() noexcept override;
  void take_back(SlotChain slots) noexcept override { give_back(slots); }
  void use(const Catalog& catalog) noexcept override;
  std::optional<LoadResult> poll() noexcept override;

  // Of a loader with slots.
  const SlotPool& pool() const noexcept { return *pool_; }
  // Read from storage for loads that were completed.
  ByteCount bytes_loaded() const noexcept { return bytes_loaded_; }

 private:
  struct UnderWay {
    LoadRequest request;
    SlotChain slots;
    std::int64_t started_ns = 0;
    std::int64_t done_ns = 0;
    bool cancelled = false;
  };

  Result<void> fill(const UnderWay& load);
  void give_back(SlotChain& slots) noexcept;

  std::optional<SlotPool> pool_;
  bool work_given_ = false;
  std::vector<LoadWork> work_;  // by ZoneId
  LoadRates rates_;
  ZoneFiller* filler_;
  std::optional<UnderWay> load_;
  std::vector<SlotIndex> slots_;
  std::int64_t now_ns_ = 0;
  ByteCount bytes_loaded_ = 0;
};

}  // namespace zonepack
