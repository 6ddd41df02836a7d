// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/control/zone_loader.hpp"
#include "runtime/run/map_demand.hpp"
#include "runtime/run/modelled_loader.hpp"

namespace zonepack {

// A loader without slots, of which loads only take the time that the model says. Cancelled loads
// end at once.
class TimedLoader final : public ZoneLoader {
 public:
  // work: of every zone, by ZoneId; must outlive this object.
  TimedLoader(std::span<const LoadWork> work, const LoadRates& rates)
      : work_(work), rates_(rates) {}

  void advance_to(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }

  void load(const LoadRequest& request) noexcept override {
    under_way_ = request;
    done_ns_ = now_ns_ + load_time_ns(work_[request.zone], rates_);
    cancelled_ = false;
  }
  void cancel() noexcept override { cancelled_ = true; }
  void take_back(SlotChain) noexcept override {}
  void use(const Catalog& catalog) noexcept override {
    of_catalog_ = work_of(catalog);
    work_ = of_catalog_;
  }
  std::optional<LoadResult> poll() noexcept override {
    if (!under_way_ || (!cancelled_ && now_ns_ < done_ns_)) return std::nullopt;
    const LoadRequest done = *under_way_;
    under_way_.reset();
    if (cancelled_) return LoadResult{done.zone, done.generation, {ErrorCode::kCancelled, 0}, {}};
    bytes_loaded_ += work_[done.zone].stored_bytes;
    return LoadResult{done.zone, done.generation, {}, {0, 0, done.slots}};
  }

  ByteCount bytes_loaded() const noexcept { return bytes_loaded_; }

 private:
  std::span<const LoadWork> work_;
  std::vector<LoadWork> of_catalog_;
  LoadRates rates_;
  std::optional<LoadRequest> under_way_;
  std::int64_t now_ns_ = 0;
  std::int64_t done_ns_ = 0;
  bool cancelled_ = false;
  ByteCount bytes_loaded_ = 0;
};

}  // namespace zonepack
