// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/base/result.hpp"
#include "runtime/map/loader.hpp"
#include "runtime/map/rate_limit.hpp"

namespace zonepack {

// What a load needs of the thread that runs it.
class LoadHost {
 public:
  virtual ~LoadHost() = default;

  virtual std::int64_t now_ns() noexcept = 0;  // monotonic
  // Sleeps until then, or until the load is to be given up; may come back early.
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
  virtual bool cancelled() noexcept = 0;
  // After every chunk.
  virtual void loaded(const ChunkRef&) noexcept {}
};

// Takes a load to its end at no more than the limit's rate. kCancelled as soon as the load is to be
// given up: asked before every chunk and through every pause, so that at most one window
// (kReadBufferBytes) is read and one chunk decoded after the wish. Other errors: step()'s.
//
// Closing the pack costs time too (pages are dropped from the cache): tell of the end first, then
// let go of the load.
Result<void> run_load(ZoneLoad& load, RateLimit& limit, LoadHost& host) noexcept;

}  // namespace zonepack
