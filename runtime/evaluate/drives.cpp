// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/drives.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "runtime/recording/recording_reader.hpp"
#include "runtime/run/inputs/log_match.hpp"

namespace zonepack {
namespace {

Outcome<void> check_times(const Drive& drive, const LogMatch& match) {
  if (!drive.corrections.empty()) {
    std::int64_t first_ns = drive.corrections.front().stamp_ns, last_ns = first_ns;
    for (const PoseCorrection& fix : drive.corrections) {
      first_ns = std::min(first_ns, fix.stamp_ns);
      last_ns = std::max(last_ns, fix.received_ns);
    }
    auto overlap =
        check_overlap(drive.files.corrections, first_ns, last_ns, drive.files.can, match);
    if (!overlap) return overlap;
  }
  if (!drive.truth) return {};
  const std::vector<TruthTrack::Sample>& samples = drive.truth->samples();
  return check_overlap(drive.files.truth, samples.front().t_ns, samples.back().t_ns,
                       drive.files.can, match);
}

Outcome<void> read_log(Drive& drive, const Settings& settings, std::vector<std::string>& warnings) {
  const DriveFiles& files = drive.files;
  CanLogReader log(files.can, settings.can.interface);
  if (const auto opened = log.open(); !opened) {
    return failure(log.explain(opened.error()), opened.error().code);
  }
  drive.time = LogTime::read(files.can, settings.can.interface);
  auto corrections = drive.time.steps() ? read_corrections_as_written(files.corrections)
                                        : read_corrections(files.corrections);
  if (!corrections) return corrections.error();
  drive.corrections = drive.time.steps() ? drive.time.on_first_clock(std::move(*corrections))
                                         : std::move(*corrections);
  if (!files.truth.empty()) {
    auto truth = read_truth(files.truth);
    if (!truth) return truth.error();
    drive.truth = drive.time.on_first_clock(*truth);
  }
  LogMatch match(log);
  while (const auto frame = match.next()) drive.frames.push_back(*frame);
  drive.log = log.summary();
  if (drive.frames.empty()) return failure(files.can + ": the CAN log holds no frame");
  const std::string mismatch = match.mismatch(settings.odometry.wheels, files.can, log.summary());
  if (!mismatch.empty()) warnings.push_back(mismatch);
  return check_times(drive, match);
}

// Names of zones of the maps that a recording speaks of, by their numbers in the run.
class RecordedNames {
 public:
  explicit RecordedNames(const RecordingReader& recording) : recording_(recording) {}

  Outcome<void> begin() {
    const RecordingPreface& preface = recording_.preface();
    return add(1, preface.manifest, preface.map_folder);
  }
  Outcome<void> offered(std::uint32_t number) {
    if (const RecordedMap* const map = recording_.map(number)) {
      if (auto added = add(number, map->manifest, map->folder); !added) return added;
    }
    last_ = number;
    return {};
  }
  std::string name(std::uint32_t map, ZoneId zone) const {
    const auto found = names_.find(map == 0 ? last_ : map);
    if (found == names_.end() || zone >= found->second.size()) return {};
    return found->second[zone];
  }

 private:
  Outcome<void> add(std::uint32_t number, ByteSpan manifest, const std::string& folder) {
    const auto catalog = Catalog::read(manifest, folder, kDefaultPayload);
    if (!catalog) {
      return failure("the recorded map cannot be used: " + catalog.error().message,
                     catalog.error().code);
    }
    for (const CatalogZone& zone : catalog->zones) names_[number].push_back(zone.name);
    return {};
  }

  const RecordingReader& recording_;
  std::map<std::uint32_t, std::vector<std::string>> names_;
  std::uint32_t last_ = 1;
};

void add_cycle(Drive& drive, const RecordedInput& input, const RecordedNames& names) {
  const auto append = [](auto& all, const auto& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(drive.frames, input.frames);
  append(drive.corrections, input.corrections);
  append(drive.edges, input.edges);
  for (const Command& command : input.commands) {
    Drive::NamedCommand named{command, names.name(command.map, command.zone), {}};
    for (std::uint32_t i = 0; i < command.route_length; ++i) {
      named.route.push_back(names.name(command.map, command.route[i]));
    }
    drive.commands.push_back(std::move(named));
  }
  drive.cycles.push_back({input.now_ns, drive.frames.size(), drive.corrections.size(),
                          drive.commands.size(), drive.edges.size()});
}

Outcome<void> read_recording(Drive& drive, std::vector<std::string>& warnings) {
  const std::string& path = drive.files.recording;
  auto recording = RecordingReader::open(path);
  if (!recording) return recording.error();
  RecordedNames names(*recording);
  const auto in_file = [&](const Failure& cause) {
    return Failure{cause.code, path + ": " + cause.message};
  };
  if (const auto begun = names.begin(); !begun) return in_file(begun.error());
  if (const auto& checkpoint = recording->checkpoint()) {
    if (checkpoint->has_pose) {
      drive.start =
          RunStart{checkpoint->now_ns, checkpoint->T_map_base, std::max(checkpoint->sigma_m, 1e-3),
                   std::max(checkpoint->sigma_rad, 1e-3)};
    }
  } else {
    drive.start = recording->preface().start;
  }
  while (const RecordedInput* const input = recording->next()) {
    if (input->offer.map != 0) {
      if (const auto known = names.offered(input->offer.map); !known) return in_file(known.error());
    }
    add_cycle(drive, *input, names);
  }
  if (!recording->note().empty()) warnings.push_back(recording->note());
  if (drive.cycles.empty()) return failure(path + ": holds no cycle");
  return {};
}

}  // namespace

Outcome<Drive> read_drive(const DriveFiles& files, const Settings& settings,
                          std::vector<std::string>& warnings) {
  Drive drive;
  drive.files = files;
  auto read =
      drive.recorded() ? read_recording(drive, warnings) : read_log(drive, settings, warnings);
  if (!read) return read.error();
  if (!files.baseline.empty()) {
    auto rows = read_baseline(files.baseline);
    if (!rows) return rows.error();
    drive.baseline = std::move(*rows);
  }
  return drive;
}

Outcome<std::vector<TimedCommand>> commands_on(const Drive& drive, const Catalog& catalog) {
  std::error_code ignored;  // a pipe is read once, and was
  if (drive.recorded() || !std::filesystem::is_regular_file(drive.files.corrections, ignored)) {
    return std::vector<TimedCommand>{};
  }
  auto commands = read_command_lines(drive.files.corrections,
                                     [&](std::string_view name) { return catalog.find(name); });
  if (!commands) return commands;
  for (TimedCommand& command : *commands) {
    command.received_ns = drive.time.on_first_clock(command.received_ns);
  }
  return commands;
}

std::optional<Command> on_map(const Drive::NamedCommand& recorded, const Catalog& catalog) {
  using Kind = Command::Kind;
  Command command = recorded.command;
  command.map = 0;
  switch (command.kind) {
    case Kind::kPin:
    case Kind::kUnpin:
      command.zone = catalog.find(recorded.zone);
      if (command.zone == kNoZone) return std::nullopt;
      return command;
    case Kind::kSeek:
      command.zone = recorded.zone.empty() ? kNoZone : catalog.find(recorded.zone);
      return command;
    case Kind::kRouteHint:
      command.route_length = 0;
      for (const std::string& name : recorded.route) {
        const ZoneId zone = catalog.find(name);
        if (zone != kNoZone) command.route[command.route_length++] = zone;
      }
      return command;
    case Kind::kLease:
    case Kind::kRelease:
    case Kind::kMapFreed:
      return std::nullopt;
    case Kind::kFreeze:
    case Kind::kUnfreeze:
    case Kind::kLost:
    case Kind::kAskTurn:
      return command;
  }
  return std::nullopt;
}

}  // namespace zonepack
