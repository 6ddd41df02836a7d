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
  // Sleeps until then, or until the load is to be given up; may return early.
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
  virtual bool cancelled() noexcept = 0;
  // Called after every chunk.
  virtual void loaded(const ChunkRef&) noexcept {}
};

// Runs a load to its end at no more than the limit's rate. kCancelled once the load is to be given
// up, which is checked before every chunk and during every pause: at most one window
// (kReadBufferBytes) is read and one chunk decoded after the request. Other errors are those of
// step().
//
// Closing the pack takes time too (its pages are dropped from the cache): report the end first,
// then destroy the load.
Result<void> run_load(ZoneLoad& load, RateLimit& limit, LoadHost& host) noexcept;

}  // namespace zonepack
