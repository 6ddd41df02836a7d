// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "runtime/zone_loader.hpp"

namespace zonepack {

// The loader of a run that is driven again from its recording: nothing is loaded, and results come
// from the recording. Remembers what the cycle asked for, to tell whether a result is an answer.
class RecordedLoader final : public ZoneLoader {
 public:
  void load(const LoadRequest& request) noexcept override { asked_ = request; }
  void cancel() noexcept override {}
  void take_back(SlotChain) noexcept override {}
  void use(const Catalog&) noexcept override {}
  std::optional<LoadResult> poll() noexcept override { return std::nullopt; }

  const std::optional<LoadRequest>& asked() const noexcept { return asked_; }

  // Whether the result answers what was asked and not yet answered; then it is answered.
  bool answer(const LoadResult& result) noexcept {
    const bool right = asked_ && result.zone == asked_->zone &&
                       result.generation == asked_->generation &&
                       (result.error.code != ErrorCode::kOk || result.slots.count == asked_->slots);
    if (right) asked_.reset();
    return right;
  }

 private:
  std::optional<LoadRequest> asked_;
};

}  // namespace zonepack
