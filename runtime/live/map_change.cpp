// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/map_change.hpp"

#include <utility>

#include "platform/files/storage.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/messages/print_line.hpp"
#include "runtime/map/next_version.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack {

void MapChange::turn() {
  switch (step_) {
    case Step::kNone:
      if (std::exchange(asked_, false)) begin();
      return;
    case Step::kPreparing:
      if (const auto prepared = job_.poll()) end_preparing(*prepared);
      return;
    case Step::kAnnouncing:
      if (ports_.service.ready_for(next_) && ports_.loop.offer(next_->in_use())) {
        step_ = Step::kOffered;
      }
      return;
    case Step::kOffered:
      return take_unused();
    case Step::kFreeing:
      if (!ports_.service.done_with(leaving_) || !leaving_map_.expired()) return;
      give_back_heap();
      if (leaving_ != last_number_) ports_.loop.map_freed();
      step_ = Step::kNone;
      return;
  }
}

void MapChange::begin() {
  const auto in_use = ports_.run.find(in_use_);
  const auto started = job_.start([this, in_use] { return prepare(*in_use); });
  if (started) {
    step_ = Step::kPreparing;
  } else {
    print_line("the map is not changed: no thread can be had to read it");
    ports_.loop.offer_refused(started.error().code);
  }
}

// In a thread of its own.
Result<std::uint64_t> MapChange::prepare(const MapVersion& in_use) {
  auto next = make_next(in_use);
  give_back_heap();  // what the manifest took, and all of it after a refusal
  if (!next) {
    failure_ = next.error().message;
    return next.error().code;
  }
  // What the control thread is going to touch; where this is refused, the start said so.
  if (ports_.settings.realtime.lock_memory) (void)lock_memory_now();
  next_ = std::move(*next);
  return std::uint64_t{next_->model().needs.size()};
}

Outcome<std::shared_ptr<MapVersion>> MapChange::make_next(const MapVersion& in_use) {
  const std::string& folder = in_use.catalog().folder;
  const std::string path = folder + "/" + std::string(kManifestName);
  const ByteCount room = in_use.model().room_for_next();
  auto manifest = read_manifest_file(folder, room, ReadMode::kBuffered);
  auto catalog = manifest ? Catalog::read(*manifest, folder, in_use.catalog().payload, room)
                          : Outcome<Catalog>(manifest.error());
  if (!catalog && catalog.error().code == ErrorCode::kNoRoom) {
    return failure(path + ": " + catalog.error().message + " beside the map in use (budget of " +
                       format_byte_count(in_use.model().limits.budget) +
                       "); start zoned again with this map, or with a larger budget",
                   ErrorCode::kTooLarge);
  }
  if (!catalog) {
    return failure(path + ": " + catalog.error().message +
                       "; expected a manifest as zonepack build writes it: copy it again, as the "
                       "last file, or build the map again",
                   catalog.error().code);
  }
  if (auto chosen = catalog->choose_layers(ports_.settings.memory.layers); !chosen) {
    return failure(path + ": " + chosen.error().message, chosen.error().code);
  }
  const auto checked = check_next_version(in_use.catalog(), *catalog, ports_.settings.loading.read);
  if (!checked) return checked.error();
  const std::size_t zones = catalog->zones.size();
  if (zones > ports_.shared.zone_capacity()) {
    return failure(path + ": has " + std::to_string(zones) + " zones, over the " +
                       std::to_string(ports_.shared.zone_capacity()) +
                       " that there is room for since zoned was started; start it again with this "
                       "map",
                   ErrorCode::kTooLarge);
  }
  auto map = ports_.run.prepare(last_number_ + 1, std::move(catalog).value());
  if (!map) return failure(path + ": " + map.error().message, ErrorCode::kNoRoom);
  ports_.recording.add_map({(*map)->number(), folder, std::move(manifest).value()});
  return map;
}

void MapChange::end_preparing(const Result<std::uint64_t>& prepared) {
  if (prepared) {
    last_number_ = next_->number();
    ports_.run.add(next_);
    step_ = Step::kAnnouncing;
    return;
  }
  print_line("the map is not changed: " + std::exchange(failure_, {}));
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
  leaving_map_ = ports_.run.remove(leaving_);
  step_ = Step::kFreeing;
}

}  // namespace zonepack
