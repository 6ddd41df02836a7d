// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/live_loader.hpp"

#include "platform/base/require.hpp"
#include "platform/process/clock.hpp"
#include "runtime/map/run_load.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kLongestSleep_ns = 1'000'000'000;

std::uint64_t key_of(const LoadRequest& request) noexcept {
  return (std::uint64_t{request.zone} + 1) << 32 | request.generation;
}

}  // namespace

// Tells readers where a chunk stands; chunks come in the order in which they fill the slots.
class ChunkPlaces {
 public:
  ChunkPlaces(SharedMap& map, const std::vector<SlotIndex>& slots) : map_(map), slots_(slots) {
    for (const SlotIndex slot : slots) {
      for (SharedChunk& chunk : map.chunks(slot)) chunk = {};
    }
  }

  void add(const ChunkRef& chunk) {
    while (!holds(chunk.bytes.data())) {
      ++slot_;
      chunk_ = 0;
      ZP_REQUIRE(slot_ < slots_.size());
    }
    ZP_REQUIRE(chunk_ < kMaxChunksPerSlot);
    const auto offset = chunk.bytes.data() - map_.slot(slots_[slot_]).data();
    map_.chunks(slots_[slot_])[chunk_++] = {
        static_cast<std::uint8_t>(chunk.kind),
        static_cast<std::uint8_t>(static_cast<ByteCount>(offset) / kChunkAlignment),
        static_cast<std::uint16_t>(chunk.bytes.size())};
  }

 private:
  bool holds(const std::byte* place) const {
    const auto slot = map_.slot(slots_[slot_]);
    return place >= slot.data() && place < slot.data() + slot.size();
  }

  SharedMap& map_;
  const std::vector<SlotIndex>& slots_;
  std::size_t slot_ = 0;
  std::size_t chunk_ = 0;
};

// A load as it runs in this thread.
class LiveLoader::Host final : public LoadHost {
 public:
  Host(LiveLoader& loader, const LoadRequest& request)
      : loader_(loader), request_(request), places_(loader.map_, loader.slots_) {}

  std::int64_t now_ns() noexcept override { return monotonic_ns(); }
  void sleep_until(std::int64_t time_ns) noexcept override { loader_.wakeup_.wait_until(time_ns); }
  bool cancelled() noexcept override { return loader_.cancelled(request_); }
  void loaded(const ChunkRef& chunk) noexcept override { places_.add(chunk); }

 private:
  LiveLoader& loader_;
  const LoadRequest& request_;
  ChunkPlaces places_;
};

LiveLoader::LiveLoader(const Catalog& catalog, SharedMap& map, const ReadingChoice& reading)
    : catalog_(&catalog),
      map_(map),
      pool_(map.links()),
      inbox_(map.slot_count() + 4),
      outbox_(4),
      read_buffer_(kReadBufferBytes),
      queue_(reading.mode == ReadMode::kDirect ? ReadQueue::make() : nullptr),
      mode_(reading.mode),
      rate_(reading.rate_limit) {
  slots_.reserve(map.slot_count());
  places_.reserve(map.slot_count());
}

LiveLoader::~LiveLoader() { stop(); }

Result<void> LiveLoader::start(const ThreadSettings& settings, bool allow_ordinary) {
  auto thread = Thread::start(settings, allow_ordinary, [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void LiveLoader::stop() noexcept {
  stop_.store(true);
  wakeup_.post();
  thread_.join();
}

void LiveLoader::load(const LoadRequest& request) noexcept {
  under_way_ = request;
  ZP_REQUIRE(inbox_.push({Message::Kind::kLoad, request, {}, catalog_}));
  wakeup_.post();
}

void LiveLoader::cancel() noexcept {
  if (!under_way_) return;
  cancelled_.store(key_of(*under_way_), std::memory_order_release);
  wakeup_.post();  // from a pause that keeps to the rate
}

void LiveLoader::take_back(SlotChain slots) noexcept {
  if (slots.count == 0) return;
  ZP_REQUIRE(inbox_.push({Message::Kind::kTakeBack, {}, slots, nullptr}));
}

std::optional<LoadResult> LiveLoader::poll() noexcept {
  LoadResult result;
  if (!outbox_.pop(result)) return std::nullopt;
  under_way_.reset();
  return result;
}

void LiveLoader::run() {
  while (!stop_.load()) {
    Message message;
    while (inbox_.pop(message)) {
      if (message.kind == Message::Kind::kTakeBack) {
        pool_.give_back(message.slots);
      } else {
        ZP_REQUIRE(outbox_.push(fill(message)));
        load_.reset();
      }
    }
    wakeup_.wait_until(monotonic_ns() + kLongestSleep_ns);
  }
}

LoadResult LiveLoader::fill(const Message& message) {
  const LoadRequest& request = message.request;
  LoadResult result{request.zone, request.generation, {}, {}};
  ZP_REQUIRE(pool_.take(request.slots, result.slots));
  result.error = read_zone(message, result.slots);
  if (result.error.code != ErrorCode::kOk) {
    pool_.give_back(result.slots);
  } else {
    last_load_.store({request.zone, monotonic_ns()});
  }
  return result;
}

bool LiveLoader::cancelled(const LoadRequest& request) const noexcept {
  return stop_.load(std::memory_order_relaxed) ||
         cancelled_.load(std::memory_order_acquire) == key_of(request);
}

Error LiveLoader::read_zone(const Message& message, const SlotChain& slots) {
  const LoadRequest& request = message.request;
  slots_.clear();
  places_.clear();
  for (SlotIndex slot = slots.head; slot != kNoSlot; slot = pool_.next(slot)) {
    slots_.push_back(slot);
    places_.push_back(map_.slot(slot).data());
  }
  if (cancelled(request)) return {ErrorCode::kCancelled};
  auto begun =
      ZoneLoad::begin(*message.catalog, request.zone, places_, read_buffer_, {mode_, queue_.get()});
  if (!begun) return begun.error();
  load_.emplace(std::move(begun).value());
  Host host(*this, request);
  if (const auto loaded = run_load(*load_, rate_, host); !loaded) return loaded.error();
  bytes_loaded_ += load_->stored_bytes_read();
  return {};
}

}  // namespace zonepack
