// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "runtime/ctl/commands/text_plan.hpp"
#include "runtime/protocol/messages.hpp"

namespace zonepack {

// What `zonectl watch` shows, and how: a picture of text, redrawn for every status. No terminal, no
// socket, no clock: tests check the picture.
class WatchView {
 public:
  struct Zone {
    std::string name;
    wire::ZoneState state = wire::ZoneState::Absent;
    bool wanted = false;
    bool pinned = false;
    std::uint32_t leases = 0;
    std::uint32_t signatures = 0;
    std::uint64_t bytes = 0;
  };
  struct Size {
    int columns = 80;
    int rows = 24;
  };

  void set_zones(std::vector<Zone> zones) { zones_ = std::move(zones); }

  // What the plan is drawn from; by the places of zones in set_zones().
  void set_plan(TextPlan plan) { plan_ = std::move(plan); }

  // Adds a status, received `at_s` seconds after the first, to the timeline.
  void add_status(const wire::Status& status, double at_s);

  // Adds an event to the last lines.
  void add_event(const wire::Event& event);

  // Lines ending in '\n', none wider than the terminal, no more than it has rows. color: with ANSI
  // escapes.
  std::string picture(const wire::Status& status, Size size, bool color) const;

  // One line, for where no picture can be drawn.
  static std::string line(const wire::Status& status);

 private:
  struct Sample {
    double at_s = 0;
    std::string zone;
    bool resident = false;
  };

  std::string add_zones(const wire::Status& status, Size size, bool color,
                        std::vector<std::string>& lines) const;
  bool add_plan(const wire::Status& status, Size size, bool color,
                std::vector<std::string>& lines) const;

  TextPlan plan_;
  std::vector<Zone> zones_;
  std::deque<Sample> timeline_;
  std::deque<std::string> events_;
};

// One event as a line: "12.340 s  load_done R21".
std::string event_line(const wire::Event& event);

}  // namespace zonepack
