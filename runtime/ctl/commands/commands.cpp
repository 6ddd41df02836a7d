// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/commands.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/terminal.hpp"
#include "runtime/ctl/commands/figures.hpp"
#include "runtime/ctl/commands/session.hpp"
#include "runtime/ctl/commands/watch_view.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

constexpr double kRadPerDeg = kPi / 180;

int fail(const std::string& message) {
  std::cerr << "zonectl: " << message << '\n';
  return 1;
}

const wire::Status* ask_status(CtlSession& session) {
  return session.ask<wire::Status>([](auto& b) { return wire::CreateAskStatus(b); });
}

// Calls fn(zone) for each, page by page.
template <typename Fn>
bool each_zone(CtlSession& session, std::uint32_t most, Fn fn) {
  for (std::uint32_t first = 0; first < most;) {
    const wire::Zones* const page =
        session.ask<wire::Zones>([&](auto& b) { return wire::CreateAskZones(b, first); });
    if (page == nullptr) return false;
    if (page->zones() == nullptr || page->zones()->size() == 0) return true;
    for (const wire::Zone* zone : *page->zones()) fn(*zone);
    first += page->zones()->size();
    if (first >= page->total()) return true;
  }
  return true;
}

// A wish that is answered by nothing but that it is done.
template <typename Make>
int order(const std::string& socket, Make make) {
  CtlSession session(socket);
  return session.ok() && session.ask<wire::Done>(make) != nullptr ? 0 : 1;
}

}  // namespace

std::optional<std::string> socket_path(const CtlArguments& arguments) {
  if (!arguments.socket.empty()) return arguments.socket;
  const char* const from_environment = std::getenv("ZONED_SOCKET");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  if (arguments.config.empty()) return ServeSettings().socket;
  const LoadedSettings loaded = load_settings(arguments.config);
  for (const std::string& fault : loaded.faults) std::cerr << "zonectl: " << fault << '\n';
  if (!loaded.ok()) return std::nullopt;
  if (loaded.settings.serve.socket.empty()) {
    std::cerr << "zonectl: " << arguments.config << ": serve.socket is empty: no zoned listens\n";
    return std::nullopt;
  }
  return loaded.settings.serve.socket;
}

int ctl_status(const std::string& socket, const std::string& json) {
  CtlSession session(socket);
  const wire::Status* const status = session.ok() ? ask_status(session) : nullptr;
  if (status == nullptr) return 1;
  if (json == "-") {
    std::cout << status_json(*status);
    return 0;
  }
  if (!json.empty()) {
    const auto written = write_file_atomically(json, status_json(*status));
    return written ? 0 : fail(json + ": cannot be written: " + to_string(written.error().code));
  }
  std::cout << WatchView::line(*status);
  std::cout << "map version " << map_version(*status) << '\n';
  for (const std::string& complaint : complaints(*status)) std::cout << complaint << '\n';
  for (const Figure& figure : figures_of(*status)) {
    std::printf("%-22s %s\n", figure.key,
                figure.kind != Figure::Kind::kFlag ? figure.value.c_str()
                : figure.value == "1"              ? "yes"
                                                   : "no");
  }
  for (const std::string& line : line_words(*status)) std::printf("line %s\n", line.c_str());
  return 0;
}

int ctl_metrics(const std::string& socket) {
  CtlSession session(socket);
  const wire::Status* const status = session.ok() ? ask_status(session) : nullptr;
  if (status == nullptr) return 1;
  std::cout << metrics_text(*status);
  return 0;
}

int ctl_zones(const std::string& socket) {
  CtlSession session(socket);
  if (!session.ok()) return 1;
  std::printf("%-24s %-10s %-16s %10s %12s\n", "zone", "state", "", "signatures", "bytes");
  const bool done = each_zone(session, kNoZone, [](const wire::Zone& zone) {
    std::string notes = zone.wanted() ? "wanted" : "";
    if (zone.pinned()) notes += notes.empty() ? "pinned" : " pinned";
    if (zone.leases() > 0) notes += notes.empty() ? "leased" : " leased";
    std::printf("%-24s %-10s %-16s %10u %12llu\n", std::string(view_of(zone.name())).c_str(),
                to_string(zone.state()), notes.c_str(), zone.signatures(),
                static_cast<unsigned long long>(zone.bytes()));
  });
  return done ? 0 : 1;
}

int ctl_events(const std::string& socket) {
  CtlSession session(socket);
  if (!session.ok()) return 1;
  session.connection().on_notice([](const wire::Reply& notice) {
    if (const wire::Events* const events = notice.body_as_Events();
        events != nullptr && events->events() != nullptr) {
      for (const wire::Event* event : *events->events()) std::cout << event_line(*event) << '\n';
    }
    if (const wire::Lost* const lost = notice.body_as_Lost()) {
      std::cout << "(" << lost->events() << " events lost)\n";
    }
    if (notice.body_as_MapChanged() != nullptr) std::cout << "(another map)\n";
    std::cout.flush();
  });
  watch_for_end();
  if (!session.ask<wire::Done>([](auto& b) { return wire::CreateSubscribe(b, true); })) return 1;
  while (!end_was_asked()) {
    if (!session.listen(200)) return 1;
  }
  return 0;
}

int ctl_pin(const std::string& socket, const std::string& zone, bool pin) {
  if (pin) {
    return order(socket,
                 [&](auto& b) { return wire::CreatePin(b, kNoZone, b.CreateString(zone)); });
  }
  return order(socket,
               [&](auto& b) { return wire::CreateUnpin(b, kNoZone, b.CreateString(zone)); });
}

int ctl_freeze(const std::string& socket, bool freeze) {
  if (freeze) return order(socket, [](auto& b) { return wire::CreateFreeze(b); });
  return order(socket, [](auto& b) { return wire::CreateUnfreeze(b); });
}

int ctl_pose(const std::string& socket, const PoseArguments& given) {
  const double sigma_yaw = given.sigma_yaw_deg * kRadPerDeg;
  const wire::Pose pose(given.x_m, given.y_m, given.yaw_deg * kRadPerDeg);
  const wire::Covariance covariance(given.sigma_m * given.sigma_m, 0, 0,
                                    given.sigma_m * given.sigma_m, 0, sigma_yaw * sigma_yaw);
  return order(socket, [&](auto& b) {
    return wire::CreateGivePose(b, wire::Clock::Realtime, realtime_ns(), &pose, &covariance);
  });
}

int ctl_route(const std::string& socket, const std::string& from, const std::string& to,
              bool hint) {
  CtlSession session(socket);
  if (!session.ok()) return 1;
  const wire::Route* const route = session.ask<wire::Route>([&](auto& b) {
    // "." is the robot's own zone.
    const auto start =
        from == "." ? flatbuffers::Offset<flatbuffers::String>() : b.CreateString(from);
    return wire::CreateAskRoute(b, kNoZone, start, kNoZone, b.CreateString(to), hint);
  });
  if (route == nullptr) return 1;
  if (route->names() == nullptr || route->doors() == nullptr ||
      route->doors()->size() + 1 != route->names()->size()) {
    return fail("zoned's answer is no route");
  }
  for (flatbuffers::uoffset_t i = 0; i < route->names()->size(); ++i) {
    std::printf("%s", route->names()->Get(i)->c_str());
    if (i < route->doors()->size()) {
      std::printf("  door at %.2f %.2f", route->doors()->Get(i)->x(), route->doors()->Get(i)->y());
    }
    std::printf("\n");
  }
  if (route->more()) std::printf("...\n");
  std::printf("%.1f m%s\n", route->length(), route->hinted() ? ", handed to preload" : "");
  return 0;
}

int ctl_dump(const std::string& socket, const std::string& file) {
  CtlSession session(socket);
  if (!session.ok()) return 1;
  auto to = AtomicFile::create(file);
  if (!to) return fail(file + ": cannot be written: " + to_string(to.error().code));
  // Writing takes as long as the disk does.
  session.connection().set_timeout_ms(600'000);
  const int descriptors[] = {to->descriptor()};
  const wire::Dumped* const dumped =
      session.ask<wire::Dumped>([](auto& b) { return wire::CreateDump(b); }, descriptors);
  if (dumped == nullptr) return 1;
  if (const auto done = to->commit(); !done) {
    return fail(file + ": cannot be written: " + to_string(done.error().code));
  }
  std::cout << file << ": " << dumped->bytes() << " bytes\n";
  return 0;
}

}  // namespace zonepack
