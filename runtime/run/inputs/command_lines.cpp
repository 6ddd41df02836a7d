// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/command_lines.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include "runtime/run/figures/stamp_text.hpp"

namespace zonepack {
namespace {

constexpr std::string_view kMark = "# command ";
constexpr std::string_view kExpected =
    "expected # command RECEIVED lost|seek [ZONE]|ask_turn|route_hint [ZONE/ZONE...]";
constexpr std::array kKinds = {Command::Kind::kLost, Command::Kind::kSeek, Command::Kind::kAskTurn,
                               Command::Kind::kRouteHint};

// Names apart by a slash, which no name holds; blanks around it do not count.
Outcome<TimedCommand> with_route(TimedCommand hint, std::string_view names,
                                 const std::function<ZoneId(std::string_view)>& find_zone) {
  Command& command = hint.command;
  for (bool more = true; more;) {
    const std::size_t slash = names.find('/');
    more = slash != std::string_view::npos;
    std::string_view name = names.substr(0, slash);
    if (more) names.remove_prefix(slash + 1);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    const ZoneId zone = find_zone(name);
    if (zone == kNoZone) return failure("the map has no zone " + std::string(name));
    if (command.route_length == Command::kMostRoute) {
      return failure("a route of over " + std::to_string(Command::kMostRoute) + " zones");
    }
    command.route[command.route_length++] = zone;
  }
  return hint;
}

Outcome<TimedCommand> parse(const std::string& line,
                            const std::function<ZoneId(std::string_view)>& find_zone) {
  std::istringstream words(line.substr(kMark.size()));
  std::string received, word, zone;
  words >> received >> word;
  std::getline(words >> std::ws, zone);  // a name may hold blanks
  while (!zone.empty() && (zone.back() == '\r' || zone.back() == ' ')) zone.pop_back();
  TimedCommand out;
  if (!parse_stamp(received, out.received_ns)) {
    return failure("\"" + received + "\" is not a stamp in seconds");
  }
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(),
                                 [&](Command::Kind one) { return word == to_string(one); });
  if (kind == kKinds.end()) return failure("\"" + word + "\" is not a command");
  out.command.kind = *kind;
  if (zone.empty()) return out;
  if (*kind == Command::Kind::kRouteHint) return with_route(out, zone, find_zone);
  if (*kind != Command::Kind::kSeek) return failure(word + " takes no zone");
  out.command.zone = find_zone(zone);
  if (out.command.zone == kNoZone) return failure("the map has no zone " + zone);
  return out;
}

}  // namespace

std::string command_line(std::int64_t received_ns, const Command& command, std::string_view zone) {
  constexpr std::int64_t kNsInSecond = 1'000'000'000;
  std::array<char, 40> stamp{};
  std::snprintf(stamp.data(), stamp.size(), "%lld.%09lld",
                static_cast<long long>(received_ns / kNsInSecond),
                static_cast<long long>(received_ns % kNsInSecond));
  std::string line = std::string(kMark) + stamp.data() + ' ' + to_string(command.kind);
  if (!zone.empty()) line.append(1, ' ').append(zone);
  return line + '\n';
}

Outcome<std::vector<TimedCommand>> read_command_lines(
    const std::string& path, const std::function<ZoneId(std::string_view)>& find_zone) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return failure(path + ": " + std::strerror(errno), ErrorCode::kNotFound);
  std::vector<TimedCommand> commands;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (!line.starts_with(kMark)) continue;
    auto command = parse(line, find_zone);
    if (!command) {
      return failure(path + ":" + std::to_string(number) + ": " + command.error().message + "; " +
                     std::string(kExpected));
    }
    commands.push_back(*command);
  }
  if (file.bad()) return failure(path + ": " + std::strerror(errno), ErrorCode::kIo);
  std::ranges::stable_sort(commands, {}, &TimedCommand::received_ns);
  return commands;
}

}  // namespace zonepack
