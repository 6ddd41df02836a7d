// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/drive_account.hpp"

#include <algorithm>
#include <utility>

namespace zonepack {
namespace {

// bytes * part / whole without overflow, part <= whole.
ByteCount share_of(ByteCount bytes, std::int64_t part_ns, std::int64_t whole_ns) {
  if (whole_ns <= 0 || part_ns >= whole_ns) return bytes;
  const double share = static_cast<double>(part_ns) / static_cast<double>(whole_ns);
  return static_cast<ByteCount>(static_cast<double>(bytes) * share);
}

}  // namespace

DriveAccount::DriveAccount(const MapModel& model, const LoadRates& rates)
    : model_(model), rates_(rates), zones_(model.needs.size()) {
  for (const ZoneId zone : model.pinned) zones_[zone].pinned = true;
}

void DriveAccount::on_event(const Event& event, const MapVersion&) noexcept {
  const ZoneId zone = event.zone;
  switch (event.kind) {
    case EventKind::kZoneEntered:
      enter(zone);
      break;
    case EventKind::kZoneWanted:
      want(zone);
      break;
    case EventKind::kZoneUnwanted:
      zones_[zone].wanted = false;
      settle(zone);
      break;
    case EventKind::kLoadStarted:
      begin_load(event);
      break;
    case EventKind::kLoadDone:
      bytes_read_ += model_.catalog.zones[zone].stored_bytes;
      zones_[zone].resident = true;
      break;
    case EventKind::kLoadGivenUp:
    case EventKind::kLoadFailed:
      stop_load(event);
      break;
    case EventKind::kEvicted:
      leave_memory(zone);
      settle(zone);
      break;
    default:
      break;
  }
}

void DriveAccount::enter(ZoneId zone) {
  if (zone == kNoZone) return;
  ++entered_;
  if (zone_ != kNoZone && zone_ != zone) {
    ++foreseen_.changes;
    const auto place = std::ranges::find(ahead_, zone);
    foreseen_.first_two += place != ahead_.end();
    foreseen_.first += place != ahead_.end() && place == ahead_.begin();
  }
  const ZoneId before = zone_;
  zone_ = zone;
  zones_[zone].entered = true;
  // Those farther ahead are wanted already; the zone that was left is, too, for a moment.
  ahead_.clear();
  for (ZoneId other = 0; other < zones_.size(); ++other) {
    if (zones_[other].wanted && other != zone && other != before) ahead_.push_back(other);
  }
  std::ranges::sort(ahead_, {}, [this](ZoneId other) { return zones_[other].wanted_since; });
  if (ahead_.size() > 2) ahead_.resize(2);
}

void DriveAccount::want(ZoneId zone) {
  ++requests_;
  hits_ += zones_[zone].resident;
  zones_[zone].wanted = true;
  zones_[zone].wanted_since = requests_;
  settle(zone);
  if (zone_ == kNoZone || zone == zone_ || ahead_.size() == 2) return;
  if (std::ranges::find(ahead_, zone) == ahead_.end()) ahead_.push_back(zone);
}

void DriveAccount::begin_load(const Event& event) {
  Zone& zone = zones_[event.zone];
  zone.entered = event.zone == zone_;
  zone.load_began_ns = event.t_ns;
  zone.load = given_up_.size();
  given_up_.push_back(false);
  zone.held = true;
  settle(event.zone);
}

// The storage is taken to have been read evenly over the time of the load.
void DriveAccount::stop_load(const Event& event) {
  const CatalogZone& zone = model_.catalog.zones[event.zone];
  const std::int64_t whole_ns = load_time_ns({zone.stored_bytes, zone.decoded_bytes}, rates_);
  const ByteCount read =
      share_of(zone.stored_bytes, event.t_ns - zones_[event.zone].load_began_ns, whole_ns);
  bytes_read_ += read;
  bytes_unused_ += read;
  given_up_[zones_[event.zone].load] = true;
  zones_[event.zone].held = false;
  settle(event.zone);
}

void DriveAccount::leave_memory(ZoneId zone) {
  zones_[zone].resident = zones_[zone].held = false;
  if (!zones_[zone].entered) bytes_unused_ += model_.catalog.zones[zone].stored_bytes;
}

// A step ends when a required zone is so no longer; what came between two steps without one that
// ends is part of the later one.
void DriveAccount::settle(ZoneId zone) {
  Zone& state = zones_[zone];
  const bool required = (state.wanted || state.pinned) && state.held;
  if (required == state.required) return;
  state.required = required;
  if (required) {
    required_.push_back({zone, state.load});
    grown_ = true;
    return;
  }
  end_step();
  std::erase_if(required_, [zone](const HeldBy& held) { return held.zone == zone; });
}

void DriveAccount::end_step() {
  if (grown_) held_steps_.push_back(required_);
  grown_ = false;
}

void DriveAccount::end() noexcept {
  end_step();
  for (ZoneId zone = 0; zone < zones_.size(); ++zone) {
    if (zones_[zone].resident) {
      leave_memory(zone);
    } else if (zones_[zone].held) {
      given_up_[zones_[zone].load] = true;  // the run ended first
    }
  }
  for (const std::vector<HeldBy>& all : held_steps_) {
    std::vector<ZoneId> step;
    for (const HeldBy& held : all) {
      if (!given_up_[held.load]) step.push_back(held.zone);
    }
    if (!step.empty()) steps_.steps.push_back(std::move(step));
  }
}

}  // namespace zonepack
