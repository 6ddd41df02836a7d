// SPDX-License-Identifier: Apache-2.0
// zonectl watch: the view, five times a second.
#include <iostream>

#include "platform/process/clock.hpp"
#include "platform/process/terminal.hpp"
#include "runtime/ctl/commands/commands.hpp"
#include "runtime/ctl/commands/session.hpp"
#include "runtime/ctl/commands/watch_view.hpp"

namespace zonepack {
namespace {

constexpr int kPicture_ms = 200;
constexpr int kLine_ms = 1000;
constexpr std::size_t kMostZones = 600;  // more than fit on any screen

Outcome<void> read_zones(CtlSession& session, WatchView& view) {
  std::vector<WatchView::Zone> zones;
  std::uint32_t total = 1;
  while (zones.size() < std::min<std::size_t>(total, kMostZones)) {
    const auto first = static_cast<std::uint32_t>(zones.size());
    const auto page =
        session.ask<wire::Zones>([&](auto& b) { return wire::CreateAskZones(b, first); });
    if (!page) return page.error();
    total = (*page)->total();
    if ((*page)->zones() == nullptr || (*page)->zones()->size() == 0) break;
    for (const wire::Zone* zone : *(*page)->zones()) {
      zones.push_back({.name = std::string(view_of(zone->name())),
                       .state = zone->state(),
                       .wanted = zone->wanted(),
                       .pinned = zone->pinned(),
                       .leases = zone->leases(),
                       .signatures = zone->signatures(),
                       .bytes = zone->bytes()});
    }
  }
  view.set_zones(std::move(zones));
  return {};
}

// The next status, also added to the view's timeline; never null.
Outcome<const wire::Status*> look(CtlSession& session, WatchView& view, std::int64_t started_ns) {
  auto status = session.ask<wire::Status>([](auto& b) { return wire::CreateAskStatus(b); });
  if (status) view.add_status(**status, static_cast<double>(monotonic_ns() - started_ns) / 1e9);
  return status;
}

Outcome<void> watch_lines(CtlSession& session, WatchView& view) {
  watch_for_end();
  const std::int64_t started_ns = monotonic_ns();
  for (std::int64_t line = 1; !end_was_asked(); ++line) {
    const auto status = look(session, view, started_ns);
    if (!status) return status.error();
    std::cout << WatchView::line(**status) << std::flush;
    sleep_until_ns(started_ns + line * kLine_ms * 1'000'000);
  }
  return {};
}

// The outlines of the zones that the view shows; a zoned that does not know the question gets no
// plan drawn.
TextPlan read_plan(CtlSession& session) {
  std::vector<TextPlan::Outline> zones;
  for (std::uint32_t total = 1; zones.size() < std::min<std::size_t>(total, kMostZones);) {
    const auto first = static_cast<std::uint32_t>(zones.size());
    const auto page =
        session.ask<wire::Outlines>([&](auto& b) { return wire::CreateAskOutlines(b, first); });
    if (!page || (*page)->outlines() == nullptr || (*page)->outlines()->size() == 0) break;
    total = (*page)->total();
    for (const wire::Outline* const outline : *(*page)->outlines()) {
      TextPlan::Outline& points = zones.emplace_back();
      if (outline->points() == nullptr) continue;
      for (const wire::OutlinePoint* const point : *outline->points()) {
        points.push_back({point->x(), point->y()});
      }
    }
  }
  return {std::move(zones), terminal_shows_utf8()};
}

Outcome<void> watch_screen(CtlSession& session, WatchView& view) {
  FullScreen screen;
  const bool color = terminal_shows_color();
  std::uint32_t map = 0, map_now = 1;  // that the plan is of; in use
  const std::int64_t started_ns = monotonic_ns();
  while (!screen.ended()) {
    if (auto read = read_zones(session, view); !read) return read;
    if (map != map_now) view.set_plan(read_plan(session));
    map = map_now;
    const auto status = look(session, view, started_ns);
    if (!status) return status.error();
    map_now = (*status)->map_serial();
    const TerminalSize size = terminal_size();
    screen.show(view.picture(**status, {size.columns, size.rows}, color));
    if (screen.key(kPicture_ms) == 'q') break;
  }
  return {};
}

}  // namespace

Outcome<void> ctl_watch(const std::string& socket) {
  auto session = CtlSession::open(socket);
  if (!session) return session.error();
  WatchView view;
  session->connection().on_notice([&view](const wire::Reply& notice) {
    const wire::Events* const events = notice.body_as_Events();
    if (events == nullptr || events->events() == nullptr) return;
    for (const wire::Event* event : *events->events()) view.add_event(*event);
  });
  const auto subscribed =
      session->ask<wire::Done>([](auto& b) { return wire::CreateSubscribe(b, true); });
  if (!subscribed) return subscribed.error();
  return output_is_terminal() ? watch_screen(*session, view) : watch_lines(*session, view);
}

}  // namespace zonepack
