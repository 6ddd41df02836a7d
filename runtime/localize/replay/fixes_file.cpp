// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/fixes_file.hpp"

#include <array>
#include <charconv>
#include <cstdio>

#include "platform/atomic_file.hpp"

namespace zonepack::localize {
namespace {

// Seconds with all nine decimals; stamps are not before 1970.
std::string seconds_text(std::int64_t t_ns) {
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

}  // namespace

std::string fixes_text(std::span<const LoopView> views) {
  std::string text =
      "# stamp received x y yaw sigma_x sigma_y sigma_yaw view   (seconds, metres, radians; "
      "base_link "
      "in map)\n";
  for (const LoopView& view : views) {
    if (!view.result.accepted) continue;
    const PoseCorrection& fix = view.fix;
    const std::int64_t late_ns = fix.received_ns - fix.stamp_ns;
    std::string line = seconds_text(view.image.recorded_stamp_ns) + ' ' +
                       seconds_text(view.image.recorded_stamp_ns + late_ns);
    for (const double value : {fix.T_map_base.x_m, fix.T_map_base.y_m, fix.T_map_base.yaw_rad,
                               fix.sigma_x_m, fix.sigma_y_m, fix.sigma_yaw_rad, fix.view_m}) {
      add(line, value);
    }
    text += line + '\n';
  }
  return text;
}

Outcome<void> write_fixes(const std::string& path, std::span<const LoopView> views) {
  if (const auto written = write_file_atomically(path, fixes_text(views)); !written) {
    return cannot_write(path, written.error());
  }
  return {};
}

}  // namespace zonepack::localize
