// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/status_figures.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>

namespace zonepack {
namespace {

std::string text_of(std::unsigned_integral auto value) { return std::to_string(value); }
std::string seconds_text(std::int64_t ns) { return decimal_text(static_cast<double>(ns) / 1e9); }

// The two functions of a number that is a field of the answer as it is: `source` is a member of
// StatusSource.
#define ZP_FIELD(field, source)                                                           \
  [](wire::StatusBuilder& to, const StatusSource& from) { to.add_##field(from.source); }, \
      [](const wire::Status& status) { return text_of(status.field()); }

constexpr auto kCounter = StatusFigure::Kind::kCounter;
constexpr auto kGauge = StatusFigure::Kind::kGauge;
constexpr auto kFlag = StatusFigure::Kind::kFlag;

constexpr StatusFigure kFigures[] = {
    {"uptime_s", "zoned_uptime_seconds", kGauge, "Time since the server started.",
     [](wire::StatusBuilder& to, const StatusSource& from) {
       to.add_uptime_ns(from.server.uptime_ns);
     },
     [](const wire::Status& status) { return seconds_text(status.uptime_ns()); }},
    {"map_ready", "zoned_map_ready", kFlag, "The pose is trusted and its zone is in memory.",
     ZP_FIELD(map_ready, live.state.map_ready)},
    {"zone_resident", "zoned_own_zone_resident", kFlag, "The robot's own zone is in memory.",
     ZP_FIELD(zone_resident, live.state.zone_resident)},
    {"pose_trusted", "zoned_pose_trusted", kFlag, "Two absolute fixes agreed.", nullptr,
     [](const wire::Status& status) {
       return text_of(status.pose() != nullptr && status.pose()->trusted());
     }},
    {"lost", "zoned_lost", kFlag, "A localizer searches the map for the robot.",
     ZP_FIELD(lost, live.state.lost)},
    {"pose_sigma_m", "zoned_pose_sigma_meters", kGauge, "Standard deviation of the position.",
     nullptr, [](const wire::Status& status) { return decimal_text(sigma_m_of(status.pose())); }},
    {"blocked", "zoned_blocked", kFlag, "A wanted zone does not fit next to what must stay.",
     ZP_FIELD(blocked, live.state.blocked)},
    {"frozen", "zoned_frozen", kFlag, "Nothing is evicted, by command.",
     ZP_FIELD(frozen, live.frozen)},
    {"not_keeping_up", "zoned_not_keeping_up_total", kCounter,
     "Zones entered before they were in memory.", ZP_FIELD(not_keeping_up, server.not_keeping_up)},
    {"map_serial", "zoned_map_serial", kGauge, "Number of the map in use, 1 at the start.",
     ZP_FIELD(map_serial, map.serial)},
    {"map_changes", "zoned_map_changes_total", kCounter, "Other versions of the map taken.",
     ZP_FIELD(map_changes_total, server.map_changes)},
    {"map_refusals", "zoned_map_refusals_total", kCounter, "Versions of the map not taken.",
     ZP_FIELD(map_refusals_total, server.map_refusals)},
    {"budget_bytes", "zoned_budget_bytes", kGauge, "Hard limit of what grows with the map.",
     ZP_FIELD(budget_bytes, live.budget)},
    {"charged_bytes", "zoned_charged_bytes", kGauge, "Bytes charged against the budget.",
     ZP_FIELD(charged_bytes, live.charged)},
    {"charged_signatures", "zoned_charged_signatures", kGauge, "Signatures charged for.",
     ZP_FIELD(charged_signatures, live.charged_sum.signatures)},
    {"resident_signatures", "zoned_resident_signatures", kGauge, "Signatures in memory.",
     ZP_FIELD(resident_signatures, live.resident_sum.signatures)},
    {"max_signatures", "zoned_max_signatures", kGauge, "Most signatures at once; 0: no limit.",
     ZP_FIELD(max_signatures, live.max_signatures)},
    {"zones", "zoned_zones", kGauge, "Zones of the map.", ZP_FIELD(zones, zones())},
    {"zones_resident", "zoned_zones_resident", kGauge, "Zones in memory.",
     ZP_FIELD(zones_resident, map.zones.totals().resident)},
    {"zones_filling", "zoned_zones_filling", kGauge, "Zones being loaded.",
     ZP_FIELD(zones_filling, map.zones.totals().filling)},
    {"zones_pinned", "zoned_zones_pinned", kGauge, "Zones that are never evicted.",
     ZP_FIELD(zones_pinned, map.zones.totals().pinned)},
    {"zones_loaded", "zoned_zones_loaded_total", kCounter, "Zones loaded.",
     ZP_FIELD(zones_loaded_total, live.residency.zones_loaded)},
    {"zones_unloaded", "zoned_zones_unloaded_total", kCounter, "Zones evicted.",
     ZP_FIELD(zones_unloaded_total, live.residency.zones_unloaded)},
    {"signatures_loaded", "zoned_signatures_loaded_total", kCounter, "Signatures loaded.",
     ZP_FIELD(signatures_loaded_total, live.residency.signatures_loaded)},
    {"signatures_unloaded", "zoned_signatures_unloaded_total", kCounter, "Signatures evicted.",
     ZP_FIELD(signatures_unloaded_total, live.residency.signatures_unloaded)},
    {"loads_given_up", "zoned_loads_given_up_total", kCounter, "Loads cancelled or failed.",
     ZP_FIELD(loads_given_up_total, live.residency.loads_given_up)},
    {"leases_revoked", "zoned_leases_revoked_total", kCounter,
     "Leases run out, or in the way of the robot's own zone.",
     ZP_FIELD(leases_revoked_total, live.residency.leases_revoked)},
    {"zone_switches", "zoned_zone_switches_total", kCounter, "Times the robot changed its zone.",
     ZP_FIELD(zone_switches, live.state.zone_switches)},
    {"can_frames", "zoned_can_frames_total", kCounter, "CAN frames taken.",
     ZP_FIELD(can_frames_total, live.can_frames)},
    {"can_up", "zoned_can_up", kFlag, "The CAN interface is up, its controller on the bus.",
     ZP_FIELD(can_up, can_up())},
    {"can_error_frames", "zoned_can_error_frames_total", kCounter,
     "Errors that the CAN controller reported.",
     ZP_FIELD(can_error_frames_total, live.bus.error_frames)},
    {"bus_offs", "zoned_bus_offs_total", kCounter, "Times the controller left the bus.",
     ZP_FIELD(bus_offs_total, live.bus.bus_offs)},
    {"bus_restarts", "zoned_bus_restarts_total", kCounter, "Times it was started again.",
     ZP_FIELD(bus_restarts_total, live.bus.restarts)},
    {"can_reopened", "zoned_can_reopened_total", kCounter,
     "Times that the CAN interface vanished and came back.",
     ZP_FIELD(can_reopened_total, live.bus.reconnects)},
    {"corrections_used", "zoned_corrections_used_total", kCounter, "Fixes that were believed.",
     ZP_FIELD(fixes_used_total, live.filter.used)},
    {"corrections_rejected", "zoned_corrections_rejected_total", kCounter,
     "Fixes that were refused.", ZP_FIELD(fixes_rejected_total, live.filter.rejected)},
    {"pose_reinitialised", "zoned_pose_reinitialised_total", kCounter,
     "Times that refused fixes agreed and moved the pose.",
     ZP_FIELD(pose_reinitialised_total, live.filter.reinitialised)},
    {"cycles", "zoned_cycles_total", kCounter, "Control cycles.",
     ZP_FIELD(cycles, live.state.cycles)},
    {"missed_deadlines", "zoned_missed_deadlines_total", kCounter,
     "Cycles that began a period or more late.",
     ZP_FIELD(missed_deadlines_total, live.overload.missed_deadlines)},
    {"skipped_periods", "zoned_skipped_periods_total", kCounter, "Periods without a cycle.",
     ZP_FIELD(skipped_periods_total, live.overload.skipped_periods)},
    {"deferred_frames", "zoned_deferred_frames_total", kCounter,
     "Cycles that left CAN frames waiting.",
     ZP_FIELD(deferred_frames_total, live.overload.deferred_frames)},
    {"dropped_frames", "zoned_dropped_frames_total", kCounter, "CAN frames that were lost.",
     ZP_FIELD(dropped_frames_total, live.overload.dropped_frames)},
    {"deferred_commands", "zoned_deferred_commands_total", kCounter,
     "Cycles that left commands waiting.",
     ZP_FIELD(deferred_commands_total, live.overload.deferred_commands)},
    {"lost_events", "zoned_lost_events_total", kCounter, "Events that were not written.",
     ZP_FIELD(lost_events_total, live.overload.lost_events)},
    {"lost_service_events", "zoned_lost_service_events_total", kCounter,
     "Events that did not reach the server.",
     ZP_FIELD(lost_service_events_total, live.overload.lost_service_events)},
    {"lost_records", "zoned_lost_records_total", kCounter, "Cycles missing in the account.",
     ZP_FIELD(lost_records_total, live.overload.lost_records)},
    {"lost_replies", "zoned_lost_replies_total", kCounter, "Replies to commands that were lost.",
     ZP_FIELD(lost_replies_total, live.overload.lost_replies)},
    {"lost_recordings", "zoned_lost_recordings_total", kCounter,
     "Cycles that could not be recorded.",
     ZP_FIELD(lost_recordings_total, live.overload.lost_recordings)},
    {"realtime", "zoned_realtime", kFlag, "The control thread runs as SCHED_FIFO.",
     ZP_FIELD(realtime, live.realtime)},
    {"memory_locked", "zoned_memory_locked", kFlag, "All pages are kept in memory.",
     ZP_FIELD(memory_locked, live.memory_locked)},
    {"minor_faults", "zoned_minor_faults_total", kCounter, "Of the control thread, after start.",
     ZP_FIELD(minor_faults_total, live.minor_faults)},
    {"major_faults", "zoned_major_faults_total", kCounter, "Of the control thread, after start.",
     ZP_FIELD(major_faults_total, live.major_faults)},
    {"voluntary_switches", "zoned_voluntary_switches_total", kCounter,
     "Of the control thread, after start.",
     ZP_FIELD(voluntary_switches_total, live.voluntary_switches)},
    {"involuntary_switches", "zoned_involuntary_switches_total", kCounter,
     "Of the control thread, after start.",
     ZP_FIELD(involuntary_switches_total, live.involuntary_switches)},
    {"worst_cycle_s", "zoned_worst_cycle_seconds", kGauge, "The longest cycle's own work.",
     [](wire::StatusBuilder& to, const StatusSource& from) {
       to.add_worst_cycle_ns(from.live.worst.ns);
     },
     [](const wire::Status& status) { return seconds_text(status.worst_cycle_ns()); }},
    {"clients", "zoned_clients", kGauge, "Programs connected.", ZP_FIELD(clients, server.clients)},
    {"leases", "zoned_leases", kGauge, "Leases that readers hold.",
     ZP_FIELD(leases, server.leases)},
    {"requests", "zoned_requests_total", kCounter, "Requests taken.",
     ZP_FIELD(requests_total, server.requests)},
    {"clients_refused", "zoned_clients_refused_total", kCounter, "There were too many.",
     ZP_FIELD(clients_refused_total, server.clients_refused)},
    {"clients_dropped", "zoned_clients_dropped_total", kCounter, "Programs that did not keep up.",
     ZP_FIELD(clients_dropped_total, server.clients_dropped)},
    {"throttled", "zoned_throttled_total", kCounter,
     "Times that a program had asked for all it may.", ZP_FIELD(throttled_total, server.throttled)},
    {"malformed", "zoned_malformed_total", kCounter, "Messages that could not be read.",
     ZP_FIELD(malformed_total, server.malformed)},
    {"events_undelivered", "zoned_events_undelivered_total", kCounter,
     "Events that a slow program lost.",
     ZP_FIELD(events_undelivered_total, server.events_undelivered)},
};

#undef ZP_FIELD

}  // namespace

std::span<const StatusFigure> status_figures() noexcept { return kFigures; }

std::string decimal_text(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

double sigma_m_of(const wire::PoseReport* pose) noexcept {
  if (pose == nullptr || pose->covariance() == nullptr) return 0;
  return std::sqrt(std::max(pose->covariance()->xx(), pose->covariance()->yy()));
}

}  // namespace zonepack
