// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "runtime/run/maps/map_version.hpp"

namespace zonepack {

// The maps of a run: the one in use, and another while the map changes. Code that works with one
// holds it; when the last holder of a removed one lets go, its memory is free.
//
// Threads: any.
class MapRegistry {
 public:
  void add(std::shared_ptr<MapVersion> map) {
    const std::lock_guard lock(mutex_);
    maps_.push_back(std::move(map));
  }

  // Null when it is gone.
  std::shared_ptr<MapVersion> find(std::uint32_t number) const {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(maps_, number, &MapVersion::number);
    return found == maps_.end() ? nullptr : *found;
  }

  // Expires when nobody holds it any more.
  std::weak_ptr<MapVersion> remove(std::uint32_t number) {
    std::weak_ptr<MapVersion> removed = find(number);
    const std::lock_guard lock(mutex_);
    std::erase_if(maps_, [&](const auto& map) { return map->number() == number; });
    return removed;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<MapVersion>> maps_;
};

}  // namespace zonepack
