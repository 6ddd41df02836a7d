// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/maps/map_version.hpp"

#include "runtime/control/expected_use.hpp"

namespace zonepack {

Outcome<std::shared_ptr<MapVersion>> MapVersion::make(std::uint32_t number, Catalog catalog,
                                                      const MapTerms& terms) {
  std::shared_ptr<MapVersion> map(new MapVersion(number, charged_on(std::move(catalog), terms)));
  auto model = MapModel::make(map->catalog_, terms);
  if (!model) return model.error();
  map->model_ = std::move(*model);
  map->eviction_rule_ = terms.eviction;
  if (terms.habits) {
    map->transitions_.emplace(map->model_->graph);
    if (terms.learned) restore(*terms.learned, *map->transitions_);
  }
  return map;
}

Outcome<void> MapVersion::prepare(const CycleConfig& config, ZoneLoader& loader, EventSink& events,
                                  ZoneDirectory* directory, const EvictionOrderMaker& eviction) {
  const MapModel& map = *model_;
  const ResidencyLimits& limits = map.limits;
  const EvictionPlace place{map.needs,
                            Residency::slots_within(limits.budget, limits.fixed, limits.slot_bytes),
                            transitions()};
  if (eviction) {
    eviction_ = eviction(place);
  } else if (eviction_rule_ == EvictionRule::kExpected) {
    eviction_ = make_expected_use(place);
  }
  memory_.emplace(map.needs.size(), map.limits, eviction_.get());
  if (auto pinned = map.pin(*memory_); !pinned) return pinned;
  cycle_.emplace(config, CycleParts{.graph = map.graph,
                                    .needs = map.needs,
                                    .load_s = map.load_s,
                                    .pinned = map.pinned,
                                    .memory = *memory_,
                                    .loader = loader,
                                    .events = events,
                                    .directory = directory,
                                    .map = number_,
                                    .transitions = transitions_ ? &*transitions_ : nullptr});
  in_use_.emplace(MapInUse{.catalog = catalog_,
                           .graph = map.graph,
                           .needs = map.needs,
                           .memory = *memory_,
                           .cycle = *cycle_,
                           .number = number_,
                           .slots = map.slots});
  return {};
}

}  // namespace zonepack
