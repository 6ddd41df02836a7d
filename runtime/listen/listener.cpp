// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/listener.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/live/bus/live_source.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/run/inputs/rejected_text.hpp"

namespace zonepack {
namespace {

// Whether something moved, and stands now.
bool done_moving(const ListenPicture& picture) {
  constexpr double kStanding_m_s = 0.005;
  bool moved = false;
  for (const ListenPicture::Row& row : picture.rows) {
    if (row.signal->key.empty()) continue;
    if (row.state == SignalState::kFresh && std::abs(row.speed_m_s) > kStanding_m_s) return false;
    moved = moved || row.least_seen != row.most_seen;
  }
  return moved;
}

}  // namespace

const char* word_of(SignalState state) {
  switch (state) {
    case SignalState::kNeverSeen:
      return "never seen";
    case SignalState::kFresh:
      return "fresh";
    case SignalState::kStale:
      return "stale";
    case SignalState::kOutOfRange:
      return "out of range";
    case SignalState::kUnreadable:
      break;
  }
  return "unreadable";  // too short, a remote request, not finite
}

Listener::Listener(const Settings& settings, Reference reference,
                   std::optional<ExpectedMotion> expected)
    : settings_(settings),
      expected_(std::move(expected)),
      names_(message_names(settings)),
      wheels_(settings, std::move(reference)) {
  for (NamedSignal& signal : named_signals(settings)) {
    SignalTrace trace(signal.signal, signal.position);
    watched_.push_back({std::move(signal), trace, {}});
  }
}

void Listener::take(const CanFrame& frame) {
  first_ns_ = frames_ == 0 ? frame.stamp_ns : std::min(first_ns_, frame.stamp_ns);
  last_ns_ = frames_ == 0 ? frame.stamp_ns : std::max(last_ns_, frame.stamp_ns);
  ++frames_;
  if (frame.error) {
    ++error_frames_;
    return;
  }
  bool named = false;
  for (Watched& watched : watched_) {
    const CanSignal& signal = watched.signal.signal;
    named = named || (signal.id == frame.id && signal.extended == frame.extended);
    if (watched.trace.take(frame).status == SignalReading::Status::kValue) {
      watched.meter.add(frame.stamp_ns, watched.trace.moved());
    }
  }
  const MessageId id(frame.id, frame.extended);
  if (!named) {
    const auto known = ids_.find(id);
    if (known != ids_.end()) {
      known->second.add(frame.stamp_ns);
    } else if (ids_.size() < kMostIds) {
      ids_[id].add(frame.stamp_ns);
    }
  }
  if (!wheels_.take(frame)) return;
  ++samples_;
  const OdometryIncrement& increment = *wheels_.increment();
  const Pose2& motion = increment.motion.pose;
  pose_ = compose(pose_, motion);
  const double seconds = static_cast<double>(increment.to_ns - increment.from_ns) * 1e-9;
  distance_m_ += std::hypot(increment.speed_m_s, increment.sideways_m_s) * seconds;
  forward_m_ += increment.speed_m_s * seconds;
  heading_rad_ += increment.yaw_rate_rad_s * seconds;
  forward_.add(increment.to_ns, forward_m_);
  turning_.add(increment.to_ns, heading_rad_);
}

bool Listener::heard_odometry() const noexcept {
  return std::any_of(watched_.begin(), watched_.end(), [](const Watched& watched) {
    return !watched.signal.key.empty() && watched.trace.count() + watched.trace.refused() > 0;
  });
}

ListenPicture::Row Listener::row_of(const Watched& watched, std::int64_t now_ns, bool whole) const {
  const NamedSignal& signal = watched.signal;
  const SignalTrace& trace = watched.trace;
  ListenPicture::Row row;
  row.signal = &signal;
  row.count = trace.count();
  if (trace.last_refused()) row.state = SignalState::kUnreadable;
  if (row.count == 0) return row;
  row.raw = trace.raw_number();
  row.value = trace.last().value;
  row.least_seen = trace.least();
  row.most_seen = trace.most();
  row.rate_hz = whole ? watched.meter.mean_rate_hz() : watched.meter.rate_hz(now_ns);
  row.age_s = std::max(0.0, static_cast<double>(now_ns - trace.last_ns()) * 1e-9);
  row.speed_m_s = signal.position ? watched.meter.slope_per_s() * signal.si_per_unit
                                  : row.value * signal.si_per_unit;
  row.moved_m = trace.moved() * signal.si_per_unit;
  if (row.state == SignalState::kUnreadable) return row;
  const bool outside =
      (signal.least && row.value < *signal.least) || (signal.most && row.value > *signal.most);
  row.state = row.age_s > settings_.odometry.wheels.timeout_s ? SignalState::kStale
              : outside                                       ? SignalState::kOutOfRange
                                                              : SignalState::kFresh;
  return row;
}

void Listener::add_others(std::int64_t now_ns, bool whole, ListenPicture& picture) const {
  const std::vector<CanId> watched = odometry_ids(settings_.odometry.wheels);
  for (const auto& [number, meter] : ids_) {
    const CanId id{number.first, number.second};
    if (std::find(watched.begin(), watched.end(), id) != watched.end()) continue;
    picture.others.push_back(
        {id, "", meter.count(), whole ? meter.mean_rate_hz() : meter.rate_hz(now_ns)});
  }
  std::stable_sort(picture.others.begin(), picture.others.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  if (picture.others.size() > kMostOthers) {
    picture.further_ids = picture.others.size() - kMostOthers;
    picture.others.resize(kMostOthers);
  }
  for (ListenPicture::Other& other : picture.others) {
    const auto name = names_.find({other.id.id, other.id.extended});
    if (name != names_.end()) other.name = name->second;
  }
}

ListenPicture Listener::picture(std::int64_t now_ns, bool whole) const {
  ListenPicture picture;
  picture.seconds = frames_ > 0 ? static_cast<double>(last_ns_ - first_ns_) * 1e-9 : 0;
  picture.frames = frames_;
  picture.error_frames = error_frames_;
  for (const Watched& watched : watched_) picture.rows.push_back(row_of(watched, now_ns, whole));
  add_others(now_ns, whole, picture);
  const WheelOdometry& odometry = wheels_.odometry();
  picture.stale = odometry.stale(now_ns);
  if (!picture.stale) {
    picture.speed_m_s = forward_.slope_per_s();
    picture.yaw_rate_rad_s = turning_.slope_per_s();
  }
  picture.distance_m = distance_m_;
  picture.heading_rad = heading_rad_;
  picture.pose = pose_;
  picture.samples = samples_;
  picture.refused = odometry.counters().rejected;
  picture.refused_why = rejected_text(odometry.counters(), settings_.odometry.wheels);
  WheelEvidence evidence = wheels_.evidence();
  evidence.expected = expected_;
  picture.reference = evidence.reference;
  picture.compared = evidence.windows.size();
  picture.hints = wheel_hints(settings_, evidence);
  if (expected_ && !whole && !done_moving(picture)) {
    // Until then only directions can be judged.
    const auto early = [](const WheelHint& hint) {
      return hint.kind != "sign" && hint.kind != "swapped";
    };
    picture.hints.erase(std::remove_if(picture.hints.begin(), picture.hints.end(), early),
                        picture.hints.end());
  }
  return picture;
}

}  // namespace zonepack
