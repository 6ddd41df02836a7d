// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/calibrate/wheel_hints.hpp"
#include "runtime/calibrate/wheel_watch.hpp"
#include "runtime/listen/named_signal.hpp"
#include "runtime/listen/signal_meter.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

enum class SignalState { kNeverSeen, kFresh, kStale, kOutOfRange, kUnreadable };
const char* word_of(SignalState state);

// What was heard so far, to be shown.
struct ListenPicture {
  struct Row {
    const NamedSignal* signal = nullptr;  // of the listener
    SignalState state = SignalState::kNeverSeen;
    std::uint64_t count = 0;
    double raw = 0, value = 0, rate_hz = 0, age_s = 0;
    double least_seen = 0, most_seen = 0;
    double speed_m_s = 0;  // of a wheel, over the ground
    double moved_m = 0;    // of a wheel, signed
  };
  struct Other {
    CanId id;
    std::string name;  // of the DBC file; may be empty
    std::uint64_t count = 0;
    double rate_hz = 0;
  };
  double seconds = 0;
  std::uint64_t frames = 0, error_frames = 0;
  std::vector<Row> rows;
  std::vector<Other> others;    // the most frequent ids that no setting names
  std::size_t further_ids = 0;  // besides these
  double speed_m_s = 0, yaw_rate_rad_s = 0;
  double distance_m = 0;   // way travelled, either direction
  double heading_rad = 0;  // turned since the start, counter-clockwise; full turns count
  Pose2 pose;              // seen from where the robot started
  std::uint64_t samples = 0, refused = 0;
  std::string refused_why;   // with counts; empty when none was
  bool stale = true;         // odometry: no sample for odometry.timeout
  std::string reference;     // what the wheels are compared with; empty: nothing
  std::size_t compared = 0;  // windows of the drive in which they could be
  std::vector<WheelHint> hints;
};

// Decodes the frames of a bus and follows the wheels through them.
//
// Memory: bounded, however long it listens.
// Threads: one.
class Listener {
 public:
  static constexpr std::size_t kMostIds = 1024;
  static constexpr std::size_t kMostOthers = 6;

  // `settings` must outlive this object.
  Listener(const Settings& settings, Reference reference, std::optional<ExpectedMotion> expected);

  void take(const CanFrame& frame);

  // As of now_ns, on the clock of the stamps. `whole`: rates over everything that was heard, and an
  // expected motion is over; else its amount is judged only once the robot stands again.
  ListenPicture picture(std::int64_t now_ns, bool whole) const;

  // The latest stamp; meaningful once a frame came.
  std::int64_t last_ns() const noexcept { return last_ns_; }

  // Any frame with a signal that odometry reads.
  bool heard_odometry() const noexcept;

 private:
  struct Watched {
    NamedSignal signal;
    SignalTrace trace;
    SignalMeter meter;
  };
  ListenPicture::Row row_of(const Watched& watched, std::int64_t now_ns, bool whole) const;
  void add_others(std::int64_t now_ns, bool whole, ListenPicture& picture) const;

  const Settings& settings_;
  std::optional<ExpectedMotion> expected_;
  std::map<MessageId, std::string> names_;  // of messages
  WheelWatch wheels_;
  std::vector<Watched> watched_;
  std::map<MessageId, SignalMeter> ids_;  // that no setting names
  std::uint64_t frames_ = 0, error_frames_ = 0, samples_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  Pose2 pose_;
  double distance_m_ = 0, forward_m_ = 0, heading_rad_ = 0;
  SignalMeter forward_, turning_;
};

}  // namespace zonepack
