// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/maps/modelled_loader.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr std::uint64_t kNsPerSecond = 1'000'000'000;

// bytes / rate in nanoseconds, rounded down, without overflow: the remainder is split off first,
// and a rate over 10^9 is taken in steps of 1000, which is exact enough for a model.
std::int64_t time_ns(ByteCount bytes, std::uint64_t rate) noexcept {
  const std::uint64_t seconds = bytes / rate;
  std::uint64_t rest = bytes % rate;
  std::uint64_t per = rate;
  while (per > kNsPerSecond) {
    rest /= 1000;
    per /= 1000;
  }
  return static_cast<std::int64_t>(seconds * kNsPerSecond + rest * kNsPerSecond / per);
}

}  // namespace

std::int64_t load_time_ns(const LoadWork& work, const LoadRates& rates) noexcept {
  return time_ns(work.stored_bytes, rates.storage) + time_ns(work.decoded_bytes, rates.decode);
}

std::vector<LoadWork> work_of(const Catalog& catalog) {
  std::vector<LoadWork> work;
  for (const CatalogZone& zone : catalog.zones) {
    work.push_back({zone.stored_bytes, zone.decoded_bytes});
  }
  return work;
}

ModelledLoader::ModelledLoader(const Catalog& catalog, std::uint32_t slots, const LoadRates& rates,
                               ZoneFiller* filler)
    : ModelledLoader(slots, work_of(catalog), rates, filler) {
  work_given_ = false;
}

ModelledLoader::ModelledLoader(std::uint32_t slots, std::vector<LoadWork> work,
                               const LoadRates& rates, ZoneFiller* filler)
    : pool_(std::in_place, slots),
      work_given_(true),
      work_(std::move(work)),
      rates_(rates),
      filler_(filler) {
  slots_.reserve(slots);
}

ModelledLoader::ModelledLoader(const Catalog& catalog, const LoadRates& rates)
    : work_(work_of(catalog)), rates_(rates), filler_(nullptr) {}

void ModelledLoader::use(const Catalog& catalog) noexcept {
  if (!work_given_) work_ = work_of(catalog);
  if (filler_ != nullptr) filler_->use(catalog);
}

void ModelledLoader::give_back(SlotChain& slots) noexcept {
  if (pool_) pool_->give_back(slots);
  slots = {};
}

void ModelledLoader::load(const LoadRequest& request) noexcept {
  ZP_REQUIRE(!load_);
  load_ =
      UnderWay{request, {}, now_ns_, now_ns_ + load_time_ns(work_[request.zone], rates_), false};
  if (pool_) {
    ZP_REQUIRE(pool_->take(request.slots, load_->slots));
  } else {
    load_->slots = {0, 0, request.slots};
  }
}

void ModelledLoader::cancel() noexcept {
  if (!load_ || load_->cancelled) return;
  load_->cancelled = true;
  if (!pool_) {
    load_->done_ns = now_ns_;
    return;
  }
  // A load ends between two chunks; chunks are taken to be one slot each.
  const std::int64_t whole_ns = load_->done_ns - load_->started_ns;
  const std::int64_t chunk_ns =
      std::max<std::int64_t>(1, whole_ns / std::max<std::int64_t>(1, load_->request.slots));
  const std::int64_t chunks = (now_ns_ - load_->started_ns + chunk_ns - 1) / chunk_ns;
  load_->done_ns = std::min(load_->done_ns, load_->started_ns + chunks * chunk_ns);
}

Result<void> ModelledLoader::fill(const UnderWay& load) {
  if (filler_ == nullptr) return {};
  slots_.clear();
  SlotIndex slot = load.slots.head;
  for (std::uint32_t i = 0; i < load.slots.count; ++i, slot = pool_->next(slot)) {
    slots_.push_back(slot);
  }
  return filler_->fill(load.request.zone, slots_);
}

std::optional<LoadResult> ModelledLoader::poll() noexcept {
  if (!load_ || now_ns_ < load_->done_ns) return std::nullopt;
  LoadResult result{load_->request.zone, load_->request.generation, {}, load_->slots};
  if (load_->cancelled) {
    result.error = {ErrorCode::kCancelled, 0};
  } else {
    result.error = fill(*load_).error();
  }
  if (result.error.code == ErrorCode::kOk) {
    bytes_loaded_ += work_[result.zone].stored_bytes;
  } else {
    give_back(result.slots);
  }
  load_.reset();
  return result;
}

}  // namespace zonepack
