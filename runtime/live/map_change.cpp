// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/map_change.hpp"

#include <utility>
#include <vector>

#include "platform/realtime.hpp"
#include "platform/storage.hpp"
#include "runtime/map/next_version.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/run/run_inputs.hpp"

namespace zonepack {

void MapChange::turn() {
  switch (step_) {
    case Step::kNone:
      if (std::exchange(asked_, false)) begin();
      return;
    case Step::kPreparing:
      if (const auto prepared = job_.poll()) end_preparing(*prepared);
      return;
    case Step::kTelling:
      if (ports_.service.ready_for(next_) && ports_.loop.offer(next_->in_use())) {
        step_ = Step::kOffered;
      }
      return;
    case Step::kOffered:
      return take_unused();
    case Step::kFreeing:
      if (!ports_.service.done_with(leaving_) || !leaving_map_.expired()) return;
      if (leaving_ != last_number_) ports_.loop.map_freed();
      step_ = Step::kNone;
      return;
  }
}

void MapChange::begin() {
  const auto in_use = ports_.maps.find(in_use_);
  const auto started = job_.start([this, in_use] { return prepare(*in_use); });
  if (started) {
    step_ = Step::kPreparing;
  } else {
    ports_.tell("the map is not changed: no thread can be had to read it");
    ports_.loop.offer_refused(started.error().code);
  }
}

// In a thread of its own.
Result<std::uint64_t> MapChange::prepare(const MapVersion& in_use) {
  const std::string& folder = in_use.catalog().folder;
  const std::string path = folder + "/" + std::string(kManifestName);
  auto manifest = read_file(path, kMaxManifestFileBytes, ReadMode::kBuffered);
  auto catalog = manifest ? Catalog::read(*manifest, folder, in_use.catalog().payload)
                          : Result<Catalog>(manifest.error());
  if (!catalog) {
    fault_ = path + ": " + to_string(catalog.error().code) + " (" +
             std::to_string(catalog.error().detail) +
             "), expected a manifest as zonepack build writes it; copy it again, as the last file";
    return catalog.error();
  }
  if (const auto checked = check_next_version(in_use.catalog(), *catalog, ports_.read); !checked) {
    fault_ = checked.error().message;
    return checked.error().code;
  }
  const std::size_t zones = catalog->zones.size();
  if (zones > ports_.shared.zone_capacity()) {
    fault_ = path + ": has " + std::to_string(zones) + " zones, over the " +
             std::to_string(ports_.shared.zone_capacity()) +
             " that there is room for since zoned was started; start it again with this map";
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(zones)};
  }
  auto map = MapVersion::make(last_number_ + 1, std::move(catalog).value(), ports_.terms, fault_);
  if (map == nullptr || !map->prepare(cycle_config(ports_.settings), ports_.loader, ports_.events,
                                      &ports_.shared, fault_)) {
    fault_.insert(0, path + ": ");
    return ErrorCode::kNoRoom;
  }
  ports_.recording.add_map({map->number(), folder, std::move(manifest).value()});
  // What the control thread is going to touch; where this is refused, the start said so.
  if (ports_.settings.realtime.lock_memory) (void)lock_memory_now();
  next_ = std::move(map);
  return std::uint64_t{zones};
}

void MapChange::end_preparing(const Result<std::uint64_t>& prepared) {
  if (prepared) {
    last_number_ = next_->number();
    ports_.maps.add(next_);
    step_ = Step::kTelling;
    return;
  }
  ports_.tell("the map is not changed: " + std::exchange(fault_, {}));
  if (prepared.error().code != ErrorCode::kExists) {
    ports_.loop.offer_refused(prepared.error().code);
  }
  step_ = Step::kNone;
}

void MapChange::take_unused() {
  const MapInUse* const unused = ports_.loop.take_unused();
  if (unused == nullptr) return;
  leaving_ = unused->number;
  if (leaving_ == in_use_) in_use_ = next_->number();
  next_.reset();
  leaving_map_ = ports_.maps.remove(leaving_);
  step_ = Step::kFreeing;
}

}  // namespace zonepack
