// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/zoned_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "platform/process/clock.hpp"
#include "runtime/localize/query/fix_slack.hpp"
#include "runtime/odometry/det_math.hpp"

namespace zonepack::localize {
namespace {

constexpr double kPerMoved = 0.1;     // of the way or turn since the pose, as its sigma
constexpr double kMostAhead_s = 0.5;  // farther, the last speed says nothing

std::string advice(const Error& error) {
  switch (error.code) {
    case ErrorCode::kNotFound:
      return "no zoned listens there; start zoned run, or name its socket by --socket or "
             "ZONED_SOCKET";
    case ErrorCode::kBusy:
      return "zoned does not answer, or has too many clients; try again";
    case ErrorCode::kCancelled:
      return "zoned has closed the connection";
    case ErrorCode::kBadVersion:
      return "zoned is of another version; use the zoneloc that came with it";
    case ErrorCode::kIo:
      return reason_text(error) +
             (error.detail == EACCES
                  ? "; the mode and group of the socket decide who may (serve.mode)"
                  : "");
    default:
      return std::string("not understood: ") + to_string(error.code);
  }
}

Result<void> done_or(const Result<const wire::Reply*>& reply) {
  if (!reply) return reply.error();
  switch ((*reply)->fault()) {
    case wire::Fault::None:
      return {};
    case wire::Fault::Busy:
      return ErrorCode::kBusy;
    case wire::Fault::Denied:
      return {ErrorCode::kIo, EACCES};
    default:
      return {ErrorCode::kBadValue, static_cast<std::int64_t>((*reply)->fault())};
  }
}

wire::Clock wire_clock(ImageClock clock) noexcept {
  switch (clock) {
    case ImageClock::kMonotonic:
      return wire::Clock::Monotonic;
    case ImageClock::kRealtime:
      return wire::Clock::Realtime;
    case ImageClock::kRun:
      break;
  }
  return wire::Clock::Run;
}

}  // namespace

std::int64_t on_run_clock(std::int64_t stamp_ns, ImageClock clock, const RobotState& state,
                          std::int64_t real_minus_monotonic_ns) noexcept {
  switch (clock) {
    case ImageClock::kMonotonic:
      return stamp_ns + real_minus_monotonic_ns - state.offset_ns;
    case ImageClock::kRealtime:
      return stamp_ns - state.offset_ns;
    case ImageClock::kRun:
      break;
  }
  return stamp_ns;
}

QueryPrior pose_at(const RobotState& state, std::int64_t run_ns) noexcept {
  QueryPrior prior = state.pose;
  const double dt_s =
      std::clamp(static_cast<double>(run_ns - state.pose_ns) / 1e9, -kMostAhead_s, kMostAhead_s);
  const double way_m = state.speed_m_s * dt_s, turn_rad = state.yaw_rate_rad_s * dt_s;
  const double heading = prior.T_map_base.yaw_rad + turn_rad / 2;
  prior.T_map_base.x_m += way_m * std::cos(heading);
  prior.T_map_base.y_m += way_m * std::sin(heading);
  prior.T_map_base.yaw_rad = wrap_angle(prior.T_map_base.yaw_rad + turn_rad);
  const double way_sigma_m = kPerMoved * way_m, turn_sigma_rad = kPerMoved * turn_rad;
  prior.covariance.xx += way_sigma_m * way_sigma_m;
  prior.covariance.yy += way_sigma_m * way_sigma_m;
  prior.covariance.yaw_yaw += turn_sigma_rad * turn_sigma_rad;
  return prior;
}

Outcome<ZonedLink> ZonedLink::open(const std::string& socket) {
  Result<Client> client = Client::connect(socket, "zoneloc");
  if (!client) return failure(socket + ": " + advice(client.error()), client.error().code);
  return ZonedLink(std::move(client).value());
}

std::optional<std::string> ZonedLink::detector() const {
  const auto* const detector = client_.connection().welcome().detector();
  if (detector == nullptr) return std::nullopt;
  return detector->str();
}

Result<RobotState> ZonedLink::state() {
  MessageBuilder message;
  const auto reply = client_.connection().ask(message, wire::CreateAskStatus(message.builder()));
  if (!reply) return reply.error();
  const wire::Status* const status = (*reply)->body_as_Status();
  if (status == nullptr) return ErrorCode::kBusy;
  RobotState state;
  state.received_ns = monotonic_ns();
  state.run_ns = status->now_ns();
  state.offset_ns = status->clock_offset_ns();
  state.lost = status->lost();
  if (const wire::Pose* const wheels = status->wheels();
      wheels != nullptr && std::isfinite(wheels->x() + wheels->y() + wheels->yaw())) {
    state.wheels = Pose2{wheels->x(), wheels->y(), wheels->yaw()};
  }
  const wire::PoseReport* const pose = status->pose();
  if (pose == nullptr) return state;
  state.trusted = pose->trusted();
  state.zone = pose->zone();
  state.own_resident = state.zone == kNoZone || status->zone_resident();
  if (!pose->valid() || pose->pose() == nullptr || pose->covariance() == nullptr) {
    return state;
  }
  const wire::Covariance& c = *pose->covariance();
  const double values[] = {pose->pose()->x(),
                           pose->pose()->y(),
                           pose->pose()->yaw(),
                           pose->speed(),
                           pose->yaw_rate(),
                           c.xx(),
                           c.xy(),
                           c.x_yaw(),
                           c.yy(),
                           c.y_yaw(),
                           c.yaw_yaw()};
  if (!std::all_of(std::begin(values), std::end(values),
                   [](double value) { return std::isfinite(value); })) {
    return ErrorCode::kBadStructure;
  }
  state.has_pose = true;
  state.pose_ns = pose->stamp_ns();
  state.pose.T_map_base = {values[0], values[1], values[2]};
  state.pose.covariance = {c.xx(), c.xy(), c.x_yaw(), c.yy(), c.y_yaw(), c.yaw_yaw()};
  state.speed_m_s = pose->speed();
  state.yaw_rate_rad_s = pose->yaw_rate();
  return state;
}

Result<void> ZonedLink::give(const QueryResult& fix, std::int64_t stamp_ns, ImageClock clock) {
  MessageBuilder message;
  const Covariance2& c = fix.covariance;
  const wire::Pose pose(fix.pose.x_m, fix.pose.y_m, fix.pose.yaw_rad);
  const wire::Covariance covariance(c.xx, c.xy, c.x_yaw, c.yy, c.y_yaw, c.yaw_yaw);
  return done_or(client_.connection().ask(
      message, wire::CreateGivePose(message.builder(), wire_clock(clock), stamp_ns, &pose,
                                    &covariance, kView_m)));
}

Result<void> ZonedLink::report(const FixCounters& counters, const std::string& camera) {
  MessageBuilder message;
  const auto body = counters.put(message.builder(), camera);
  return done_or(
      client_.connection().ask(message, wire::CreateReportLocalizer(message.builder(), body)));
}

Result<void> ZonedLink::lose_pose() {
  MessageBuilder message;
  return done_or(client_.connection().ask(message, wire::CreateLosePose(message.builder())));
}

Result<void> ZonedLink::seek(ZoneId zone) {
  MessageBuilder message;
  return done_or(client_.connection().ask(message, wire::CreateSeekZone(message.builder(), zone)));
}

Result<void> ZonedLink::ask_turn() {
  MessageBuilder message;
  return done_or(client_.connection().ask(message, wire::CreateAskTurn(message.builder())));
}

Result<std::vector<SearchZone>> ZonedLink::search_zones() {
  const auto all = client_.zones();
  if (!all) return all.error();
  std::vector<SearchZone> zones;
  for (const ZoneInfo& zone : *all) zones.push_back({zone.signatures, {}, {}});
  for (std::uint32_t first = 0; first < zones.size();) {
    MessageBuilder message;
    const auto reply =
        client_.connection().ask(message, wire::CreateAskOutlines(message.builder(), first));
    if (!reply) return reply.error();
    const wire::Outlines* const page = (*reply)->body_as_Outlines();
    if (page == nullptr || page->outlines() == nullptr || page->outlines()->size() == 0) break;
    for (const wire::Outline* const outline : *page->outlines()) {
      if (outline->zone() >= zones.size() || outline->points() == nullptr) continue;
      Ring ring;
      for (const wire::OutlinePoint* const point : *outline->points()) {
        ring.push_back({static_cast<double>(point->x()), static_cast<double>(point->y())});
      }
      zones[outline->zone()].middle = middle_of(ring);
    }
    first += page->outlines()->size();
  }
  return zones;
}

void ZonedLink::hold(ZoneId zone, const std::function<void()>& fn) {
  const Result<ZoneLease> lease = client_.lease(zone);
  fn();
  if (lease) static_cast<void>(client_.release(*lease));
}

}  // namespace zonepack::localize
