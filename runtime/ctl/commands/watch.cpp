// SPDX-License-Identifier: Apache-2.0
// zonectl watch: the view, five times a second.
#include "platform/clock.hpp"
#include "platform/terminal.hpp"
#include "runtime/ctl/commands/commands.hpp"
#include "runtime/ctl/commands/session.hpp"
#include "runtime/ctl/commands/watch_view.hpp"

namespace zonepack {
namespace {

constexpr int kPicture_ms = 200;
constexpr int kLine_ms = 1000;
constexpr std::size_t kMostZones = 600;  // more than fit on any screen

bool read_zones(CtlSession& session, WatchView& view) {
  std::vector<WatchView::Zone> zones;
  std::uint32_t total = 1;
  while (zones.size() < std::min<std::size_t>(total, kMostZones)) {
    const auto first = static_cast<std::uint32_t>(zones.size());
    const wire::Zones* const page =
        session.ask<wire::Zones>([&](auto& b) { return wire::CreateAskZones(b, first); });
    if (page == nullptr) return false;
    total = page->total();
    if (page->zones() == nullptr || page->zones()->size() == 0) break;
    for (const wire::Zone* zone : *page->zones()) {
      zones.push_back({std::string(view_of(zone->name())), zone->state(), zone->wanted(),
                       zone->pinned(), zone->leases(), zone->signatures(), zone->bytes()});
    }
  }
  view.set_zones(std::move(zones));
  return true;
}

// The next status, in the view's timeline; null when zoned is gone, which was told.
const wire::Status* look(CtlSession& session, WatchView& view, std::int64_t started_ns) {
  const wire::Status* const status =
      session.ask<wire::Status>([](auto& b) { return wire::CreateAskStatus(b); });
  if (status != nullptr) {
    view.add_status(*status, static_cast<double>(monotonic_ns() - started_ns) / 1e9);
  }
  return status;
}

int watch_lines(CtlSession& session, WatchView& view) {
  watch_for_end();
  const std::int64_t started_ns = monotonic_ns();
  for (std::int64_t line = 1; !end_was_asked(); ++line) {
    const wire::Status* const status = look(session, view, started_ns);
    if (status == nullptr) return 1;
    std::cout << WatchView::line(*status) << std::flush;
    sleep_until_ns(started_ns + line * kLine_ms * 1'000'000);
  }
  return 0;
}

// False when zoned is gone.
bool watch_screen(CtlSession& session, WatchView& view) {
  FullScreen screen;
  const std::int64_t started_ns = monotonic_ns();
  while (!screen.ended()) {
    if (!read_zones(session, view)) return false;
    const wire::Status* const status = look(session, view, started_ns);
    if (status == nullptr) return false;
    const TerminalSize size = terminal_size();
    screen.show(view.picture(*status, {size.columns, size.rows}, true));
    if (screen.key(kPicture_ms) == 'q') return true;
  }
  return true;
}

}  // namespace

int ctl_watch(const std::string& socket) {
  CtlSession session(socket);
  if (!session.ok()) return 1;
  WatchView view;
  session.connection().on_notice([&view](const wire::Reply& notice) {
    const wire::Events* const events = notice.body_as_Events();
    if (events == nullptr || events->events() == nullptr) return;
    for (const wire::Event* event : *events->events()) view.add_event(*event);
  });
  if (!session.ask<wire::Done>([](auto& b) { return wire::CreateSubscribe(b, true); })) return 1;
  if (!output_is_terminal()) return watch_lines(session, view);
  return watch_screen(session, view) ? 0 : 1;
}

}  // namespace zonepack
