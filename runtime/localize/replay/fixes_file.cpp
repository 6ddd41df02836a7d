// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/fixes_file.hpp"

#include <array>
#include <charconv>
#include <cstdio>

#include "platform/files/atomic_file.hpp"

namespace zonepack::localize {
namespace {

// Seconds with all nine decimals; stamps are not before 1970.
std::string stamp_text(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%lld.%09lld", static_cast<long long>(t_ns / kSecond_ns),
                static_cast<long long>(t_ns % kSecond_ns));
  return text.data();
}

void add(std::string& line, double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  line += ' ';
  line.append(text.data(), end);
}

// What the clock of the cycles is ahead of the log's at that time: as at the last image before.
std::int64_t added_at(std::int64_t t_ns, std::span<const LoopView> views) {
  std::int64_t added_ns = 0;
  for (const LoopView& view : views) {
    if (view.image.stamp_ns > t_ns && &view != views.data()) break;
    added_ns = view.image.stamp_ns - view.image.recorded_stamp_ns;
  }
  return added_ns;
}

}  // namespace

std::string fixes_text(std::span<const LoopView> views, std::span<const TimedCommand> commands,
                       const Catalog* map) {
  std::string text =
      "# stamp received x y yaw sigma_x sigma_y sigma_yaw view   (seconds, metres, radians; "
      "base_link "
      "in map)\n";
  for (const TimedCommand& command : commands) {
    const ZoneId zone = command.command.zone;
    const bool named = map != nullptr && zone < map->zones.size();
    text += command_line(command.received_ns - added_at(command.received_ns, views),
                         command.command, named ? map->zones[zone].name : std::string());
  }
  for (const LoopView& view : views) {
    if (!view.result.accepted) continue;
    const PoseCorrection& fix = view.fix;
    const std::int64_t late_ns = fix.received_ns - fix.stamp_ns;
    std::string line = stamp_text(view.image.recorded_stamp_ns) + ' ' +
                       stamp_text(view.image.recorded_stamp_ns + late_ns);
    for (const double value : {fix.T_map_base.x_m, fix.T_map_base.y_m, fix.T_map_base.yaw_rad,
                               fix.sigma_x_m, fix.sigma_y_m, fix.sigma_yaw_rad, fix.view_m}) {
      add(line, value);
    }
    text += line + '\n';
  }
  return text;
}

Outcome<void> write_fixes(const std::string& path, std::span<const LoopView> views,
                          std::span<const TimedCommand> commands, const Catalog* map) {
  if (const auto written = write_file_atomically(path, fixes_text(views, commands, map));
      !written) {
    return cannot_write(path, written.error());
  }
  return {};
}

}  // namespace zonepack::localize
