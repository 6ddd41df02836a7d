// SPDX-License-Identifier: Apache-2.0
#include "runtime/learn/zone_drive.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>

#include "platform/can/can_log.hpp"
#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/replay/recorded_run.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/run/figures/stamp_text.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr const char* kColumns = "expected a line `stamp zone`";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r,;";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool begins_as_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, sizeof(kRecordingMagic)> head{};
  file.read(head.data(), head.size());
  return file && std::memcmp(head.data(), kRecordingMagic, head.size()) == 0;
}

Outcome<ZoneDrive> drive_of(const std::string& name, DriveListener& listener) {
  return ZoneDrive{name, std::move(listener.visits)};
}

}  // namespace

void DriveListener::on_event(const Event& event, const MapVersion& map) noexcept {
  if (event.kind != EventKind::kZoneEntered) return;
  visits.push_back(
      {event.t_ns, event.zone == kNoZone ? std::string() : map.model().graph.name(event.zone)});
}

Outcome<ZoneDrive> read_zone_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return failure(path + ": " + std::strerror(errno) +
                       "; expected a recording (zoned run --record), or lines `stamp zone`",
                   ErrorCode::kNotFound);
  }
  ZoneDrive drive{path, {}};
  std::array<char, kLongestLine> buffer{};
  for (std::size_t number = 1; file.getline(buffer.data(), buffer.size()) || file.gcount() > 0;
       ++number) {
    const auto wrong = [&](const std::string& what) {
      return failure(path + ":" + std::to_string(number) + ": " + what + "; " + kColumns);
    };
    if (file.fail()) return wrong("a line of over " + std::to_string(kLongestLine - 2) + " bytes");
    const std::string_view line = trimmed(buffer.data());
    if (line.empty() || line.front() == '#') continue;
    const std::string_view stamp = line.substr(0, line.find_first_of(" \t,;"));
    const std::string zone(trimmed(line.substr(stamp.size())));
    ZoneDrive::Visit visit;
    if (!parse_stamp(stamp, visit.t_ns)) return wrong("it does not begin with a stamp in seconds");
    if (zone.empty() || name_fault(zone))
      return wrong("what follows the stamp is no name of a zone");
    if (!drive.visits.empty()) {
      if (visit.t_ns < drive.visits.back().t_ns) return wrong("the stamp is before the last one");
      if (zone == drive.visits.back().zone) continue;
    }
    visit.zone = zone;
    drive.visits.push_back(std::move(visit));
  }
  if (file.bad()) return failure(path + ": " + std::strerror(errno), ErrorCode::kIo);
  return drive;
}

Outcome<ZoneDrive> read_recorded_drive(const std::string& path) {
  auto recording = RecordingReader::open(path);
  if (!recording) return recording.error();
  const auto in_recording = [&](const Failure& cause) {
    return Failure{cause.code, path + ": " + cause.message};
  };
  const auto run = open_recorded_run(recording->preface());
  if (!run) return in_recording(run.error());
  DriveListener listener;
  const auto result = replay_recording(*recording, *run, "", &listener);
  if (!result) return in_recording(result.error());
  return drive_of(path, listener);
}

Outcome<ZoneDrive> read_logged_drive(const std::string& config, const std::string& map,
                                     const std::string& can, const std::string& corrections) {
  RunChoices choices;
  choices.config = config;
  choices.map = map;
  choices.corrections = corrections;
  auto inputs = read_run_inputs(choices);
  if (!inputs) return inputs.error();
  CanLogReader log(can, inputs->settings.can.interface);
  if (const auto opened = log.open(); !opened) {
    return failure(log.explain(opened.error()), opened.error().code);
  }
  const LogTime time = LogTime::read(can, inputs->settings.can.interface);
  if (time.steps() && !corrections.empty()) {
    auto written = read_corrections_as_written(corrections);
    if (!written) return written.error();
    inputs->corrections = time.on_first_clock(std::move(*written));
  }
  LogMatch frames(log);
  DriveListener listener;
  ReplayInput input{inputs->catalog, frames};
  input.corrections = std::move(inputs->corrections);
  input.cycle = cycle_config(inputs->settings);
  input.most_frames = inputs->settings.cycle.most_frames;
  input.terms = map_terms(choices, *inputs);
  input.load_packs = false;
  input.observer = &listener;
  const auto result = replay(std::move(input));
  if (!result) return Failure{result.error().code, can + ": " + result.error().message};
  return drive_of(can, listener);
}

Outcome<ZoneDrive> read_drive(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored) || begins_as_recording(path)) {
    return read_recorded_drive(path);
  }
  return read_zone_file(path);
}

}  // namespace zonepack
