// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/run_load.hpp"

namespace zonepack {

Result<void> run_load(ZoneLoad& load, RateLimit& limit, LoadHost& host) noexcept {
  ByteCount counted = 0;
  for (;;) {
    const ByteCount fetched = load.bytes_fetched();
    const std::int64_t now = host.now_ns();
    const std::int64_t wait = fetched == counted ? 0 : limit.spend(fetched - counted, now);
    counted = fetched;
    while (!host.cancelled() && host.now_ns() - now < wait) host.sleep_until(now + wait);
    if (host.cancelled()) return ErrorCode::kCancelled;
    const Result<bool> more = load.step();
    if (!more) return more.error();
    if (!*more) return {};
    host.loaded(load.chunks().back());
  }
}

}  // namespace zonepack
