// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/base/result.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// Where readers look up which zones are resident and where.
// Real-time: neither call blocks, allocates or throws.
// Threads: called by the control thread.
class ZoneDirectory {
 public:
  virtual ~ZoneDirectory() = default;

  // The zone can be read from here on.
  virtual void publish(ZoneId zone, std::uint32_t generation, const SlotChain& slots) noexcept = 0;

  // Called before the zone's slots are reused: what is read from here on is not valid.
  virtual void withdraw(ZoneId zone) noexcept = 0;

  // Another map with that many zones begins; all zones of the last one were withdrawn. kTooLarge
  // when there is no room for that many, and nothing has changed.
  virtual Result<void> begin_map(std::uint32_t zones) noexcept = 0;
};

}  // namespace zonepack
