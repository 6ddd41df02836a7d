// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/map_version.hpp"

#include "platform/base/require.hpp"

namespace zonepack {

std::shared_ptr<MapVersion> MapVersion::make(std::uint32_t number, Catalog catalog,
                                             const MapTerms& terms, std::string& fault) {
  std::shared_ptr<MapVersion> map(new MapVersion(number, std::move(catalog)));
  map->model_ = MapModel::make(map->catalog_, terms, fault);
  return map->model_ == nullptr ? nullptr : map;
}

bool MapVersion::prepare(const CycleConfig& config, ZoneLoader& loader, EventSink& events,
                         ZoneDirectory* directory, std::string& fault) {
  const MapModel& map = *model_;
  memory_.emplace(map.needs.size(), map.limits);
  if (!map.pin(*memory_, fault)) return false;
  cycle_.emplace(config, CycleParts{map.graph, map.needs, map.load_s, map.pinned, *memory_, loader,
                                    events, directory, number_});
  in_use_.emplace(MapInUse{catalog_, map.graph, map.needs, *memory_, *cycle_, number_, map.slots});
  return true;
}

void MapFollower::follow(std::uint32_t number) {
  if (number == map_->number()) return;
  std::shared_ptr<const MapVersion> next = find_(number);
  ZP_REQUIRE(next != nullptr);
  change_(*next);
  map_ = std::move(next);  // the one before may go with this
}

}  // namespace zonepack
