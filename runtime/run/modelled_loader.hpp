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
#include "runtime/memory/slot_pool.hpp"

namespace zonepack {

// Puts a zone's signatures into slots, at once.
class ZoneFiller {
 public:
  virtual ~ZoneFiller() = default;
  virtual Result<void> fill(ZoneId zone, std::span<const SlotIndex> slots) = 0;
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

// Time for one piece of work after the other: stored / storage + decoded / decode, each rounded
// down.
std::int64_t load_time_ns(const LoadWork& work, const LoadRates& rates) noexcept;

// The loader of a replay: zones are really loaded, by the filler, but when a load is done is
// calculated from its bytes. Nothing is measured, so every machine gives the same run.
class ModelledLoader final : public ZoneLoader {
 public:
  // work: of every zone, by ZoneId; must outlive this object. No filler: zones are only accounted
  // for.
  ModelledLoader(std::uint32_t slots, std::span<const LoadWork> work, const LoadRates& rates,
                 ZoneFiller* filler);

  // Results up to now_ns may be polled from here on. Loads start, and are cancelled, at this time.
  void advance_to(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }

  void load(const LoadRequest& request) noexcept override;
  void cancel() noexcept override;
  void take_back(SlotChain slots) noexcept override { pool_.give_back(slots); }
  void use(const Catalog&) noexcept override {}  // of the work given: one map, or one like it
  std::optional<LoadResult> poll() noexcept override;

  const SlotPool& pool() const noexcept { return pool_; }
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

  SlotPool pool_;
  std::span<const LoadWork> work_;
  LoadRates rates_;
  ZoneFiller* filler_;
  std::optional<UnderWay> load_;
  std::vector<SlotIndex> slots_;
  std::int64_t now_ns_ = 0;
  ByteCount bytes_loaded_ = 0;
};

}  // namespace zonepack
