// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "runtime/control/zone_loader.hpp"
#include "runtime/map/catalog.hpp"

namespace zonepack {

// The loader of a run that is driven again from its recording: nothing is loaded, and results come
// from the recording. Remembers what the cycle asked for, to check whether a result answers it.
class RecordedLoader final : public ZoneLoader {
 public:
  // Must outlive this object, like every catalog given to use().
  explicit RecordedLoader(const Catalog& catalog) : catalog_(&catalog) {}

  void load(const LoadRequest& request) noexcept override {
    asked_ = request;
    asked_of_ = catalog_;
  }
  void cancel() noexcept override {}
  void take_back(SlotChain) noexcept override {}
  void use(const Catalog& catalog) noexcept override { catalog_ = &catalog; }
  std::optional<LoadResult> poll() noexcept override { return std::nullopt; }

  const std::optional<LoadRequest>& asked() const noexcept { return asked_; }

  // Whether the result answers what was asked and not yet answered; then it is answered.
  bool answer(const LoadResult& result) noexcept {
    const bool right = asked_ && result.zone == asked_->zone &&
                       result.generation == asked_->generation &&
                       (result.error.code != ErrorCode::kOk || result.slots.count == asked_->slots);
    if (!right) return false;
    asked_.reset();
    if (result.error.code == ErrorCode::kOk) {
      bytes_loaded_ += asked_of_->zones[result.zone].stored_bytes;
    }
    return true;
  }

  ByteCount bytes_loaded() const noexcept { return bytes_loaded_; }

 private:
  const Catalog* catalog_;
  const Catalog* asked_of_ = nullptr;
  std::optional<LoadRequest> asked_;
  ByteCount bytes_loaded_ = 0;
};

}  // namespace zonepack
