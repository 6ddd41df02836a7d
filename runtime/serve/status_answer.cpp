// SPDX-License-Identifier: Apache-2.0
// The two answers that tell how the run stands.
#include "runtime/serve/answers.hpp"

namespace zonepack {
namespace {

wire::Timing timing(const TimingFigures& figures) {
  return {figures.count, figures.p50, figures.p99, figures.p999, figures.p9999, figures.max};
}

flatbuffers::Offset<wire::PoseReport> pose_report(flatbuffers::FlatBufferBuilder& builder,
                                                  const LiveStatus& status) {
  const PoseEstimate& pose = status.state.pose;
  const wire::Pose at(pose.T_map_base.x_m, pose.T_map_base.y_m, pose.T_map_base.yaw_rad);
  const Covariance2& c = pose.covariance;
  const wire::Covariance covariance(c.xx, c.xy, c.x_yaw, c.yy, c.y_yaw, c.yaw_yaw);
  return wire::CreatePoseReport(builder, pose.t_ns, &at, &covariance, pose.speed_m_s,
                                pose.yaw_rate_rad_s, pose.valid, pose.trusted, status.state.zone,
                                status.state.map_ready);
}

void add_run(wire::StatusBuilder& to, const LiveStatus& status) {
  to.add_now_ns(status.now_ns);
  to.add_clock_offset_ns(status.clock_offset_ns);
  to.add_zone_resident(status.state.zone_resident);
  to.add_map_ready(status.state.map_ready);
  to.add_blocked(status.state.blocked);
  to.add_frozen(status.frozen);
  to.add_cycles(status.state.cycles);
  to.add_zone_switches(status.state.zone_switches);
  to.add_can_frames_total(status.can_frames);
  to.add_fixes_used_total(status.filter.used);
  to.add_fixes_rejected_total(status.filter.rejected);
  to.add_pose_reinitialised_total(status.filter.reinitialised);
}

void add_bus(wire::StatusBuilder& to, const CanBusStatus& bus) {
  to.add_can_up(bus.link == CanLink::kUp && bus.state != CanBusState::kOff);
  to.add_can_error_frames_total(bus.error_frames);
  to.add_bus_offs_total(bus.bus_offs);
  to.add_bus_restarts_total(bus.restarts);
  to.add_can_reopened_total(bus.reconnects);
}

void add_memory(wire::StatusBuilder& to, const LiveStatus& status) {
  to.add_budget_bytes(status.budget);
  to.add_charged_bytes(status.charged);
  to.add_charged_slots(status.charged_sum.slots);
  to.add_resident_slots(status.resident_sum.slots);
  to.add_charged_signatures(status.charged_sum.signatures);
  to.add_resident_signatures(status.resident_sum.signatures);
  to.add_max_signatures(status.max_signatures);
  to.add_zones_loaded_total(status.residency.zones_loaded);
  to.add_zones_unloaded_total(status.residency.zones_unloaded);
  to.add_signatures_loaded_total(status.residency.signatures_loaded);
  to.add_signatures_unloaded_total(status.residency.signatures_unloaded);
  to.add_loads_given_up_total(status.residency.loads_given_up);
  to.add_leases_revoked_total(status.residency.leases_revoked);
}

void add_overload(wire::StatusBuilder& to, const OverloadCounters& overload) {
  to.add_missed_deadlines_total(overload.missed_deadlines);
  to.add_skipped_periods_total(overload.skipped_periods);
  to.add_deferred_frames_total(overload.deferred_frames);
  to.add_dropped_frames_total(overload.dropped_frames);
  to.add_deferred_commands_total(overload.deferred_commands);
  to.add_lost_events_total(overload.lost_events);
  to.add_lost_service_events_total(overload.lost_service_events);
  to.add_lost_records_total(overload.lost_records);
  to.add_lost_replies_total(overload.lost_replies);
  to.add_lost_recordings_total(overload.lost_recordings);
}

void add_thread(wire::StatusBuilder& to, const LiveStatus& status) {
  to.add_realtime(status.realtime);
  to.add_memory_locked(status.memory_locked);
  to.add_minor_faults_total(status.minor_faults);
  to.add_major_faults_total(status.major_faults);
  to.add_voluntary_switches_total(status.voluntary_switches);
  to.add_involuntary_switches_total(status.involuntary_switches);
  to.add_worst_cycle(status.worst.cycle);
  to.add_worst_cycle_ns(status.worst.ns);
  to.add_worst_step_ns(status.worst.step_ns);
}

void add_server(wire::StatusBuilder& to, const ServedMap& map, const ServerCounters& counters) {
  to.add_uptime_ns(counters.uptime_ns);
  to.add_not_keeping_up(counters.not_keeping_up);
  to.add_zones(static_cast<std::uint32_t>(map.zones.size()));
  to.add_zones_resident(map.zones.totals().resident);
  to.add_zones_filling(map.zones.totals().filling);
  to.add_zones_pinned(map.zones.totals().pinned);
  to.add_clients(counters.clients);
  to.add_leases(counters.leases);
  to.add_requests_total(counters.requests);
  to.add_clients_refused_total(counters.clients_refused);
  to.add_clients_dropped_total(counters.clients_dropped);
  to.add_throttled_total(counters.throttled);
  to.add_malformed_total(counters.malformed);
  to.add_events_undelivered_total(counters.events_undelivered);
  to.add_map_serial(map.serial);
  to.add_map_changes_total(counters.map_changes);
  to.add_map_refusals_total(counters.map_refusals);
}

using LineRows = flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<wire::Line>>>;

LineRows line_rows(flatbuffers::FlatBufferBuilder& builder, const LineBoard& board) {
  std::vector<flatbuffers::Offset<wire::Line>> rows;
  for (const LineRow& row : board.rows()) {
    rows.push_back(wire::CreateLine(builder, builder.CreateString(row.name), row.output,
                                    row.working.load(), row.active.load(), row.changes.load(),
                                    row.failures.load()));
  }
  return builder.CreateVector(rows);
}

}  // namespace

Message answer_status(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                      const LiveStatus& status, const ServerCounters& counters,
                      const LineBoard* board) {
  flatbuffers::FlatBufferBuilder& builder = to.builder();
  const auto pose = pose_report(builder, status);
  const bool somewhere =
      status.state.map == map.serial && status.state.zone < map.catalog.zones.size();
  const auto zone =
      builder.CreateString(somewhere ? map.catalog.zones[status.state.zone].name : std::string());
  const auto version = builder.CreateVector(map.catalog.version.data(), map.catalog.version.size());
  const auto step = builder.CreateString(to_string(status.worst.step));
  const wire::Timing wakeup = timing(status.wakeup), cycle = timing(status.cycle);
  const auto lines = board != nullptr ? line_rows(builder, *board) : LineRows();
  const wire::Timing ready =
      timing(board != nullptr ? board->ready_latency.load() : TimingFigures());
  wire::StatusBuilder body(builder);
  body.add_pose(pose);
  body.add_zone(zone);
  body.add_worst_step(step);
  body.add_map_version(version);
  body.add_wakeup(&wakeup);
  body.add_cycle(&cycle);
  body.add_lines(lines);
  body.add_map_ready_latency(&ready);
  add_run(body, status);
  add_bus(body, status.bus);
  add_memory(body, status);
  add_overload(body, status.overload);
  add_thread(body, status);
  add_server(body, map, counters);
  return to.reply(id, body.Finish());
}

Message answer_pose(MessageBuilder& to, std::uint64_t id, const LiveStatus& status) {
  return to.reply(id, pose_report(to.builder(), status));
}

}  // namespace zonepack
