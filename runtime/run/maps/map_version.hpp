// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "runtime/control/cycle.hpp"
#include "runtime/control/map_switcher.hpp"
#include "runtime/run/maps/map_model.hpp"

namespace zonepack {

// One version of the map that a run holds, from its catalog to the cycle over it. One is in use;
// while the map changes there is another.
//
// Threads: what is const, any; memory and cycle belong to the control thread while it has the map.
class MapVersion {
 public:
  // number: in the run, from 1. Fails when the map cannot be held on these terms.
  static Outcome<std::shared_ptr<MapVersion>> make(std::uint32_t number, Catalog catalog,
                                                   const MapTerms& terms);

  // Makes memory and cycle; all that is referred to outlives this object. eviction: in place of the
  // terms' rule.
  Outcome<void> prepare(const CycleConfig& config, ZoneLoader& loader, EventSink& events,
                        ZoneDirectory* directory, const EvictionOrderMaker& eviction = nullptr);

  std::uint32_t number() const noexcept { return number_; }
  const Catalog& catalog() const noexcept { return catalog_; }
  const MapModel& model() const noexcept { return *model_; }

  // Null unless the terms ask for it; belongs to the control thread with the cycle.
  const Transitions* transitions() const noexcept {
    return transitions_ ? &*transitions_ : nullptr;
  }

  // After prepare().
  Residency& memory() noexcept { return *memory_; }
  Cycle& cycle() noexcept { return *cycle_; }
  MapInUse& in_use() noexcept { return *in_use_; }

 private:
  MapVersion(std::uint32_t number, Catalog catalog)
      : number_(number), catalog_(std::move(catalog)) {}

  std::uint32_t number_;
  Catalog catalog_;
  std::unique_ptr<MapModel> model_;
  std::optional<Transitions> transitions_;
  EvictionRule eviction_rule_ = EvictionRule::kLru;
  std::unique_ptr<EvictionOrder> eviction_;
  std::optional<Residency> memory_;
  std::optional<Cycle> cycle_;
  std::optional<MapInUse> in_use_;
};

}  // namespace zonepack
