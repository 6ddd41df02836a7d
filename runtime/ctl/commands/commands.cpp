// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/commands.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "platform/base/byte_count.hpp"
#include "platform/base/counted.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/files/output_place.hpp"
#include "platform/files/write_output.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/terminal.hpp"
#include "runtime/ctl/commands/answer_json.hpp"
#include "runtime/ctl/commands/figures.hpp"
#include "runtime/ctl/commands/localizer_figures.hpp"
#include "runtime/ctl/commands/session.hpp"
#include "runtime/ctl/commands/watch_view.hpp"
#include "runtime/ctl/commands/zone_metrics.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/settings.hpp"
#include "runtime/settings/socket_place.hpp"

namespace zonepack {
namespace {

constexpr double kRadPerDeg = kPi / 180;

// Calls fn(status) with zoned's status.
template <typename Fn>
Outcome<void> with_status(const std::string& socket, Fn fn) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  const auto status = session->ask<wire::Status>([](auto& b) { return wire::CreateAskStatus(b); });
  if (!status) return status.error();
  return fn(**status);
}

// Calls fn(zone) for each zone, page by page.
template <typename Fn>
Outcome<void> each_zone(CtlSession& session, Fn fn) {
  for (std::uint32_t first = 0;;) {
    const auto page =
        session.ask<wire::Zones>([&](auto& b) { return wire::CreateAskZones(b, first); });
    if (!page) return page.error();
    const auto* const zones = (*page)->zones();
    if (zones == nullptr || zones->size() == 0) return {};
    for (const wire::Zone* zone : *zones) fn(*zone);
    first += zones->size();
    if (first >= (*page)->total()) return {};
  }
}

// A request whose only answer is that it is done.
template <typename Make>
Outcome<void> order(const std::string& socket, Make make) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  const auto done = session->ask<wire::Done>(make);
  return done ? Outcome<void>() : done.error();
}

void print_status(const wire::Status& status) {
  std::cout << WatchView::line(status);
  std::cout << "map version " << map_version(status) << '\n';
  for (const std::string& complaint : complaints(status)) std::cout << complaint << '\n';
  for (const std::string& line : figure_lines(status)) std::cout << line << '\n';
  for (const std::string& line : line_words(status)) std::cout << "line " << line << '\n';
  for (const std::string& line : localizer_lines(status)) std::cout << line << '\n';
}

}  // namespace

Outcome<std::string> socket_path(const CtlArguments& arguments) {
  if (!arguments.socket.empty()) return arguments.socket;
  const char* const from_environment = std::getenv("ZONED_SOCKET");
  if (from_environment != nullptr && *from_environment != '\0') {
    return std::string(from_environment);
  }
  if (arguments.config.empty()) return socket_to_ask();
  const LoadedSettings loaded = load_settings(arguments.config);
  if (!loaded.ok()) {
    std::string all;
    for (const std::string& fault : loaded.faults) all += (all.empty() ? "" : "\n  ") + fault;
    return failure(all);
  }
  if (loaded.settings.serve.socket.empty()) {
    return failure(arguments.config + ": serve.socket is empty: no zoned listens");
  }
  const std::string& socket = loaded.settings.serve.socket;
  return socket == ServeSettings().socket ? socket_to_ask() : socket;
}

Outcome<void> ctl_status(const std::string& socket, const std::string& json) {
  return with_status(socket, [&json](const wire::Status& status) -> Outcome<void> {
    if (!json.empty()) return write_output(json, status_json(status));
    print_status(status);
    return {};
  });
}

Outcome<void> ctl_metrics(const std::string& socket) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  const wire::Welcome& welcome = session->connection().welcome();
  std::string text = build_metrics(welcome);
  const auto status = session->ask<wire::Status>([](auto& b) { return wire::CreateAskStatus(b); });
  if (!status) return status.error();
  text += metrics_text(**status);
  ZoneMetrics zones;
  for (std::uint32_t first = 0; first != kNoZone;) {
    const auto page =
        session->ask<wire::Zones>([&](auto& b) { return wire::CreateAskZones(b, first, true); });
    if (!page) return page.error();
    const auto* const rows = (*page)->zones();
    if (rows == nullptr || rows->size() == 0) break;
    for (const wire::Zone* const zone : *rows) {
      zones.add(*zone);
      first = zone->zone() + 1;
    }
  }
  std::cout << text << zones.text();
  return {};
}

Outcome<void> ctl_zones(const std::string& socket, const std::string& json) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  std::string text;
  if (!json.empty()) {
    const auto done = each_zone(*session, [&text](const wire::Zone& zone) {
      text += (text.empty() ? "" : ",\n") + zone_json(zone);
    });
    return done ? write_output(json, "{\"zones\":[\n" + text + "\n]}\n") : done;
  }
  std::printf("%-24s %-10s %-20s %10s %10s %7s\n", "zone", "state", "", "signatures", "size",
              "entered");
  return each_zone(*session, [](const wire::Zone& zone) {
    std::string notes = zone.wanted() ? "wanted" : "";
    if (zone.pinned()) notes += notes.empty() ? "pinned" : " pinned";
    if (zone.leases() > 0) notes += notes.empty() ? "leased" : " leased";
    std::printf("%-24s %-10s %-20s %10u %10s %7u\n", std::string(view_of(zone.name())).c_str(),
                to_string(zone.state()), notes.c_str(), zone.signatures(),
                short_bytes(zone.bytes()).c_str(), zone.entered_total());
  });
}

Outcome<void> ctl_events(const std::string& socket, const std::string& json) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  std::ofstream file;
  if (!json.empty() && json != "-") {
    if (const auto possible = check_output_place(json, Overwriting::kInPlace); !possible) {
      return cannot_write(json, possible.error());
    }
    file.open(json, std::ios::app);
    if (!file) return cannot_write(json, {ErrorCode::kIo, errno});
  }
  std::ostream& output = file.is_open() ? file : std::cout;
  session->connection().on_notice([&output, &json](const wire::Reply& notice) {
    output << (json.empty() ? notice_text(notice) : notice_json(notice)) << std::flush;
  });
  watch_for_end();
  const auto subscribed =
      session->ask<wire::Done>([](auto& b) { return wire::CreateSubscribe(b, true); });
  if (!subscribed) return subscribed.error();
  while (!end_was_asked()) {
    if (auto heard = session->listen(200); !heard) return heard;
    if (!output) {
      return failure((file.is_open() ? json : "standard output") + ": cannot be written",
                     ErrorCode::kIo);
    }
  }
  return {};
}

Outcome<void> ctl_pin(const std::string& socket, const std::string& zone, bool pin) {
  if (pin) {
    return order(socket,
                 [&](auto& b) { return wire::CreatePin(b, kNoZone, b.CreateString(zone)); });
  }
  return order(socket,
               [&](auto& b) { return wire::CreateUnpin(b, kNoZone, b.CreateString(zone)); });
}

Outcome<void> ctl_freeze(const std::string& socket, bool freeze) {
  if (freeze) return order(socket, [](auto& b) { return wire::CreateFreeze(b); });
  return order(socket, [](auto& b) { return wire::CreateUnfreeze(b); });
}

Outcome<void> ctl_pose(const std::string& socket, const PoseArguments& given) {
  const double sigma_yaw = given.sigma_yaw_deg * kRadPerDeg;
  const wire::Pose pose(given.x_m, given.y_m, given.yaw_deg * kRadPerDeg);
  const wire::Covariance covariance(given.sigma_m * given.sigma_m, 0, 0,
                                    given.sigma_m * given.sigma_m, 0, sigma_yaw * sigma_yaw);
  return order(socket, [&](auto& b) {
    return wire::CreateGivePose(b, wire::Clock::Monotonic, monotonic_ns(), &pose, &covariance);
  });
}

Outcome<void> ctl_route(const std::string& socket, const std::string& from, const std::string& to,
                        bool hint, const std::string& json) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  const auto answer = session->ask<wire::Route>([&](auto& b) {
    // "." is the robot's own zone.
    const auto start =
        from == "." ? flatbuffers::Offset<flatbuffers::String>() : b.CreateString(from);
    return wire::CreateAskRoute(b, kNoZone, start, kNoZone, b.CreateString(to), hint);
  });
  if (!answer) return answer.error();
  const wire::Route& route = **answer;
  if (route.names() == nullptr || route.doors() == nullptr ||
      route.doors()->size() + 1 != route.names()->size()) {
    return failure("zoned's answer is no route");
  }
  if (!json.empty()) return write_output(json, route_json(route));
  for (flatbuffers::uoffset_t i = 0; i < route.names()->size(); ++i) {
    std::printf("%s", route.names()->Get(i)->c_str());
    if (i < route.doors()->size()) {
      std::printf("  door at %.2f %.2f", route.doors()->Get(i)->x(), route.doors()->Get(i)->y());
    }
    std::printf("\n");
  }
  if (route.more()) std::printf("...\n");
  std::printf("%.1f m%s\n", route.length(), route.hinted() ? ", handed to preload" : "");
  return {};
}

Outcome<void> ctl_dump(const std::string& socket, const std::string& file) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  auto to = AtomicFile::create(file);
  if (!to) return cannot_write(file, to.error());
  session->connection().set_timeout_ms(600'000);  // writing takes as long as the disk does
  const int descriptors[] = {to->descriptor()};
  const auto dumped =
      session->ask<wire::Dumped>([](auto& b) { return wire::CreateDump(b); }, descriptors);
  if (!dumped) return dumped.error();
  if (const auto done = to->commit(); !done) return cannot_write(file, done.error());
  std::cout << file << ": " << counted((*dumped)->bytes(), "byte") << '\n';
  return {};
}

}  // namespace zonepack
