// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_inputs.hpp"

#include <utility>

namespace zonepack {

Outcome<void> LiveInputs::open(LiveSourceTerms terms, const std::string& record_can) {
  auto source = LiveSource::open(std::move(terms));
  if (!source) return source.error();
  source_ = std::move(*source);
  if (record_can.empty()) return {};
  capture_path_ = record_can;
  capture_ = std::make_unique<CanCapture>(source_->bus(), source_->interface(),
                                          source_->clock().offset_ns());
  if (const auto opened = capture_->open(record_can); !opened) {
    return cannot_write(record_can, opened.error());
  }
  return {};
}

Outcome<void> LiveInputs::close() {
  if (!capture_) return {};
  if (const auto closed = capture_->close(); !closed) {
    return cannot_write(capture_path_, closed.error());
  }
  return {};
}

}  // namespace zonepack
