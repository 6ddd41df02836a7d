// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "runtime/control/cycle.hpp"
#include "runtime/control/map_switcher.hpp"
#include "runtime/run/map_model.hpp"

namespace zonepack {

// A map of a run, from its catalog to the cycle over it: one of them is in use, and while the map
// changes there is another.
//
// Threads: what is const, by any; memory and cycle are the control thread's while it has the map.
class MapVersion {
 public:
  // number: in the run, from 1. Null when it cannot be held on these terms, with a complete message
  // in `fault`.
  static std::shared_ptr<MapVersion> make(std::uint32_t number, Catalog catalog,
                                          const MapTerms& terms, std::string& fault);

  // Makes memory and cycle; all that is referred to outlives this object. False with a complete
  // message in `fault`.
  bool prepare(const CycleConfig& config, ZoneLoader& loader, EventSink& events,
               ZoneDirectory* directory, std::string& fault);

  std::uint32_t number() const noexcept { return number_; }
  const Catalog& catalog() const noexcept { return catalog_; }
  const MapModel& model() const noexcept { return *model_; }

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
  std::optional<Residency> memory_;
  std::optional<Cycle> cycle_;
  std::optional<MapInUse> in_use_;
};

// The map that a stream of events and records is of, for those who account for it and write it.
// Threads: one.
class MapFollower {
 public:
  using Find = std::function<std::shared_ptr<const MapVersion>(std::uint32_t number)>;
  using Change = std::function<void(const MapVersion& map)>;

  // find: a map that is in use or on offer. change: is told of every other map than `first`.
  MapFollower(std::shared_ptr<const MapVersion> first, Find find, Change change)
      : map_(std::move(first)), find_(std::move(find)), change_(std::move(change)) {}

  const MapVersion& map() const noexcept { return *map_; }

  // Before what comes next is taken: it is of the map of this number.
  void follow(std::uint32_t number);

 private:
  std::shared_ptr<const MapVersion> map_;
  Find find_;
  Change change_;
};

}  // namespace zonepack
