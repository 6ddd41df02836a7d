// SPDX-License-Identifier: Apache-2.0
// The two answers about the state of the run.
#include "runtime/serve/answers.hpp"
#include "runtime/serve/status_figures.hpp"

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

// The numbers that are not shown as figures.
void add_rest(wire::StatusBuilder& to, const LiveStatus& status) {
  to.add_now_ns(status.now_ns);
  to.add_clock_offset_ns(status.clock_offset_ns);
  to.add_charged_slots(status.charged_sum.slots);
  to.add_resident_slots(status.resident_sum.slots);
  to.add_worst_cycle(status.worst.cycle);
  to.add_worst_step_ns(status.worst.step_ns);
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
                      const LineBoard* board, const LocalizerBoard* localizers) {
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
  const auto localizing = localizers != nullptr ? localizers->put(builder) : LocalizerRows();
  wire::StatusBuilder body(builder);
  body.add_pose(pose);
  body.add_zone(zone);
  body.add_worst_step(step);
  body.add_map_version(version);
  body.add_wakeup(&wakeup);
  body.add_cycle(&cycle);
  body.add_lines(lines);
  body.add_localizers(localizing);
  body.add_map_ready_latency(&ready);
  const Pose2& wheels_pose = status.state.T_wheels_base;
  const wire::Pose wheels(wheels_pose.x_m, wheels_pose.y_m, wheels_pose.yaw_rad);
  body.add_wheels(&wheels);
  body.add_sought(status.state.sought);
  add_rest(body, status);
  const StatusSource source{status, counters, map};
  for (const StatusFigure& figure : status_figures()) {
    if (figure.put != nullptr) figure.put(body, source);
  }
  return to.reply(id, body.Finish());
}

Message answer_pose(MessageBuilder& to, std::uint64_t id, const LiveStatus& status) {
  return to.reply(id, pose_report(to.builder(), status));
}

}  // namespace zonepack
