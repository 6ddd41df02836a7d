// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "platform/memory/seqlock.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "platform/process/realtime.hpp"
#include "platform/process/wakeup.hpp"
#include "runtime/control/zone_loader.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/map/loader.hpp"
#include "runtime/map/rate_limit.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/memory/slot_pool.hpp"

namespace zonepack {

// How packs are read.
struct ReadingChoice {
  ReadMode mode = kDefaultReadMode;
  std::uint64_t rate_limit = 0;  // bytes per second, 0: none
};

// The robot's loader: a thread that reads packs into the slots of the shared map, chunk by chunk,
// and gives up between two chunks when asked to. It owns the free slots and those being filled.
//
// Real-time: the queues have room for every slot and every load, so posting cannot fail.
// Threads: the control thread calls what ZoneLoader declares, the owner all else.
class LiveLoader final : public ZoneLoader {
 public:
  // `catalog` and `map` must outlive this object. Direct reads take ReadQueue::kBytes more.
  LiveLoader(const Catalog& catalog, SharedMap& map, const ReadingChoice& reading = {});
  ~LiveLoader() override;

  Result<void> start(const ThreadSettings& settings, bool allow_ordinary);
  // Gives up the load under way and ends the thread.
  void stop() noexcept;

  void load(const LoadRequest& request) noexcept override;
  void cancel() noexcept override;
  void take_back(SlotChain slots) noexcept override;
  void use(const Catalog& catalog) noexcept override { catalog_ = &catalog; }
  std::optional<LoadResult> poll() noexcept override;

  // Of loads that were completed. Any thread.
  std::uint64_t bytes_loaded() const noexcept { return bytes_loaded_.load(); }
  struct Loaded {
    ZoneId zone = kNoZone;
    std::int64_t ns = 0;  // CLOCK_MONOTONIC
  };
  // The load that was completed last. Any thread.
  Loaded last_load() const noexcept { return last_load_.load(); }
  // Whether SCHED_FIFO was granted. Any thread.
  bool is_realtime() const noexcept { return thread_.is_realtime(); }

 private:
  class Host;
  struct Message {
    enum class Kind : std::uint8_t { kLoad, kTakeBack };
    Kind kind = Kind::kLoad;
    LoadRequest request;
    SlotChain slots;
    const Catalog* catalog = nullptr;
  };

  void run();
  LoadResult fill(const Message& message);
  Error read_zone(const Message& message, const SlotChain& slots);
  bool cancelled(const LoadRequest& request) const noexcept;

  const Catalog* catalog_;  // the control thread's
  SharedMap& map_;
  SlotPool pool_;
  SpscQueue<Message> inbox_;
  SpscQueue<LoadResult> outbox_;
  std::optional<LoadRequest> under_way_;     // the control thread's
  std::atomic<std::uint64_t> cancelled_{0};  // (zone + 1) << 32 | generation
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> bytes_loaded_{0};
  Seqlock<Loaded> last_load_;
  std::vector<SlotIndex> slots_;
  std::vector<std::byte*> places_;
  std::vector<std::byte> read_buffer_;
  std::unique_ptr<ReadQueue> queue_;  // for direct reads, where there are any
  ReadMode mode_;
  RateLimit rate_;
  std::optional<ZoneLoad> load_;  // closed after its result is out: pages are dropped then
  Wakeup wakeup_;
  Thread thread_;
};

}  // namespace zonepack
