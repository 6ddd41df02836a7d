// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sodium.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "platform/base/result.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/control/event.hpp"

namespace zonepack {

// An event as a line of the event log, '\n' included. zone: its name, where a zone is meant.
std::string event_json(const Event& event, std::string_view zone);

// The event log: one JSON object a line, in order, integers and names only, so that the same run
// gives the same bytes on every machine. Fields, always in this order:
//
//   cycle               from 0
//   t_ns                since the start of the run
//   event               start, pose_initialised, pose_trusted, pose_reinitialised,
//                       correction_rejected, odometry_stale, odometry_resumed, bus_off,
//                       bus_restarted, zone_entered, zone_wanted, zone_unwanted, load_started,
//                       load_done, load_cancelled, load_given_up, load_failed, evicted, blocked,
//                       unblocked, not_keeping_up, map_offered, map_changed, map_refused, docked,
//                       undocked, hold_begun, hold_ended, zone_confirmed, marker_ignored, end,
//                       pose_lost, zone_sought, turn_asked, pose_found, zone_kept
//                       (event.hpp says what each means)
//   zone                its name                               where a zone is meant
//   signatures          of the zone                            where a zone is meant
//   bytes               charged for the zone while it is held  where a zone is meant
//   generation          counts the loads of the zone           where a zone is meant
//   charged_signatures  of all zones, once the event has happened
//   charged_bytes       everything, once the event has happened
//   reason              a word      correction_rejected, load_failed, map_refused, marker_ignored
//   x_mm, y_mm, yaw_mrad  base_link in the map  every event that is not about memory alone, where
//                       a pose is known
//
// Threads: one; not for a control thread, whose events are handed over first.
class EventLog final : public EventSink {
 public:
  // name_of gives a zone's name; it must outlive this object.
  explicit EventLog(std::function<std::string_view(ZoneId)> name_of);

  // Writes the log to a file too, which appears whole at close(); "-": to standard output, each
  // event at once. Before the first event.
  Result<void> write_to(const std::string& path);

  void on_event(const Event& event) noexcept override;

  // After the last event: completes the file, if there is one; why it could not be written.
  Result<void> close();
  // BLAKE2b-256 of all bytes so far in hex, whether or not they could be written.
  std::string hash() const;

 private:
  std::string line_of(const Event& event) const;
  void flush();

  std::function<std::string_view(ZoneId)> name_of_;
  crypto_generichash_state hash_;
  std::optional<AtomicFile> file_;
  bool at_once_ = false;
  std::string buffer_;
  Error write_error_;
};

}  // namespace zonepack
