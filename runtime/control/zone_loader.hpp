// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/base/result.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

struct Catalog;

struct LoadRequest {
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  std::uint32_t slots = 0;  // to take from the free ones
};

// The result of a request. Without an error the zone is decoded and its slots belong to the
// receiver; with an error (kCancelled: given up on request) the loader has returned them to the
// free ones.
struct LoadResult {
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  Error error;
  SlotChain slots;
};

// The loader as the control thread sees it: messages to it and from it, each in their order. It
// owns the free slots; because slots are charged before they are asked for, and given back before
// others are charged for them, there are always enough.
//
// Real-time: no call blocks, allocates, reads a file or fails; there is room for every message, as
// at most one load is under way and a slot is in one place only.
// Threads: called by the control thread.
class ZoneLoader {
 public:
  virtual ~ZoneLoader() = default;

  virtual void load(const LoadRequest& request) noexcept = 0;

  // Asks to give up the load under way; its result still comes, at most one chunk later.
  virtual void cancel() noexcept = 0;

  // Adds the slots of an evicted zone to the free ones.
  virtual void take_back(SlotChain slots) noexcept = 0;

  // Loads requested from here on are from this map; one under way is not.
  virtual void use(const Catalog& catalog) noexcept = 0;

  // The next result, if one has come.
  virtual std::optional<LoadResult> poll() noexcept = 0;
};

}  // namespace zonepack
