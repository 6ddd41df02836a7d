// SPDX-License-Identifier: Apache-2.0
#include "runtime/learn/learn_command.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <utility>

#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/files/write_output.hpp"
#include "runtime/learn/prediction_score.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/transitions_bytes.hpp"
#include "runtime/run/inputs/run_inputs.hpp"
#include "runtime/run/maps/map_demand.hpp"
#include "runtime/run/output_check.hpp"

namespace zonepack {
namespace {

constexpr const char* kProgram = "zoned learn";

void warn(const std::string& message) { std::cerr << kProgram << ": warning: " << message << '\n'; }

struct Row {
  PredictionScore known;      // by the other drives; of a single one, by its steps so far
  PredictionScore untrained;  // by the geometry alone
};

std::string share(std::uint64_t part, std::uint64_t all) {
  if (all == 0) return "null";
  return decimals_text(static_cast<double>(part) / static_cast<double>(all), 3);
}

Outcome<std::vector<ZoneDrive>> read_drives(const LearnArguments& arguments) {
  std::vector<ZoneDrive> drives;
  for (const std::string& path : arguments.drives) {
    auto drive = read_drive(path);
    if (!drive) return drive.error();
    drives.push_back(std::move(*drive));
  }
  for (std::size_t i = 0; i < arguments.can.size(); ++i) {
    auto drive = read_logged_drive(arguments.config, arguments.map, arguments.can[i],
                                   arguments.corrections[i]);
    if (!drive) return drive.error();
    drives.push_back(std::move(*drive));
  }
  return drives;
}

class Lesson {
 public:
  Lesson(const ZoneGraph& graph, const std::optional<LearnedTransitions>& from)
      : graph_(graph), from_(from) {}

  Transitions begin() const {
    Transitions known(graph_);
    if (from_) restore(*from_, known);
    return known;
  }

  Row judge(const std::vector<ZoneDrive>& drives, std::size_t held_out) const {
    Row row;
    Transitions untrained(graph_);
    row.untrained = score_drive(drives[held_out], untrained);
    Transitions known = begin();
    for (std::size_t i = 0; i < drives.size(); ++i) {
      if (i != held_out) learn_drive(drives[i], known);
    }
    row.known = score_drive(drives[held_out], known, drives.size() == 1);
    return row;
  }

 private:
  const ZoneGraph& graph_;
  const std::optional<LearnedTransitions>& from_;
};

std::string json_of(const PredictionScore& known, const PredictionScore& untrained) {
  return "\"steps\": " + std::to_string(known.steps) +
         ", \"first\": " + share(known.first, known.steps) +
         ", \"first_two\": " + share(known.first_two, known.steps) +
         ", \"first_untrained\": " + share(untrained.first, untrained.steps) +
         ", \"first_two_untrained\": " + share(untrained.first_two, untrained.steps);
}

std::string table(const std::vector<ZoneDrive>& drives, const std::vector<Row>& rows,
                  const Row& all) {
  std::size_t width = 5;
  for (const ZoneDrive& drive : drives) width = std::max(width, drive.name.size());
  std::ostringstream out;
  const auto line = [&](const std::string& name, const Row& row) {
    out << std::left << std::setw(static_cast<int>(width)) << name << std::right << std::setw(7)
        << row.known.steps << std::setw(8) << share(row.known.first, row.known.steps)
        << std::setw(11) << share(row.known.first_two, row.known.steps) << std::setw(11)
        << share(row.untrained.first, row.untrained.steps) << '\n';
  };
  out << std::left << std::setw(static_cast<int>(width)) << "drive" << std::right
      << "  steps   first  first two  untrained\n";
  for (std::size_t i = 0; i < drives.size(); ++i) line(drives[i].name, rows[i]);
  if (drives.size() > 1) line("all", all);
  out << (drives.size() > 1
              ? "how often the next zone was the likeliest, or one of the likeliest two, by what "
                "the other drives teach\n"
              : "how often the next zone was the likeliest, or one of the likeliest two, by the "
                "steps before it\n");
  return out.str();
}

Outcome<void> write_file(const std::string& path, const std::vector<std::byte>& bytes) {
  const auto written =
      write_file_atomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!written) return cannot_write(path, written.error());
  return {};
}

Outcome<void> learn(const LearnArguments& arguments) {
  if (auto possible = check_outputs({{"--out", arguments.out}, {"--json", arguments.json, true}});
      !possible) {
    return possible;
  }
  const auto catalog = Catalog::open(arguments.map, 0);
  if (!catalog) {
    return failure(arguments.map + ": cannot be opened as a map: " + catalog.error().message +
                       "; it must hold manifest.zpm as written by zonepack build",
                   catalog.error().code);
  }
  std::optional<LearnedTransitions> from;
  if (!arguments.from.empty()) {
    auto read = load_transitions(arguments.from);
    if (!read) return read.error();
    if (read->map_lineage != catalog->lineage) {
      return failure(arguments.from + ": was learned on another map (lineage " +
                         to_hex(read->map_lineage) + "; that of " + arguments.map + " is " +
                         to_hex(catalog->lineage) + ")",
                     ErrorCode::kMismatch);
    }
    from = std::move(*read);
  }
  const auto drives = read_drives(arguments);
  if (!drives) return drives.error();

  const ZoneGraph graph = graph_of(*catalog);
  const Lesson lesson(graph, from);
  std::vector<Row> rows;
  Row all;
  for (std::size_t i = 0; i < drives->size(); ++i) {
    const ZoneDrive& drive = (*drives)[i];
    rows.push_back(lesson.judge(*drives, i));
    all.known.add(rows.back().known);
    all.untrained.add(rows.back().untrained);
    const std::vector<std::string> unknown = unknown_zones(drive, graph);
    if (!unknown.empty()) {
      warn(drive.name + ": " + counted(unknown.size(), "zone") + " that the map " + arguments.map +
           " does not have, passed over: " + unknown.front() + (unknown.size() > 1 ? ", ..." : ""));
    }
    if (rows.back().known.steps == 0) {
      return failure(drive.name + ": holds no step from a zone to a neighbour of it on the map " +
                     arguments.map + "; expected a drive through several of its zones");
    }
  }
  Transitions known = lesson.begin();
  for (const ZoneDrive& drive : *drives) learn_drive(drive, known);
  LearnedTransitions learned = save(known);
  learned.map_lineage = catalog->lineage;
  learned.map_version = catalog->version;
  const std::vector<std::byte> bytes = write_transitions(learned);
  if (auto written = write_file(arguments.out, bytes); !written) return written;

  std::ostream& text = arguments.json == "-" ? std::cerr : std::cout;
  const ByteCount charged = transitions_bytes(catalog->costs());
  text << table(*drives, rows, all) << arguments.out << ": " << counted(bytes.size(), "byte")
       << ", " << counted(learned.contexts.size(), "context") << " of "
       << counted(learned.steps, "step") << "; takes " << counted(charged, "byte")
       << " of a budget\n";
  if (arguments.json.empty()) return {};
  std::string json =
      "{\n  \"map\": " + json_quoted(arguments.map) +
      ",\n  \"out\": " + json_quoted(arguments.out) +
      ",\n  \"bytes\": " + std::to_string(bytes.size()) +
      ",\n  \"charged_bytes\": " + std::to_string(charged) +
      ",\n  \"contexts\": " + std::to_string(learned.contexts.size()) +
      ",\n  \"method\": " + json_quoted(drives->size() > 1 ? "leave-one-out" : "steps-so-far") +
      ",\n  " + json_of(all.known, all.untrained) + ",\n  \"drives\": [";
  for (std::size_t i = 0; i < drives->size(); ++i) {
    json += std::string(i > 0 ? "," : "") + "\n    {\"drive\": " + json_quoted((*drives)[i].name) +
            ", " + json_of(rows[i].known, rows[i].untrained) + "}";
  }
  return write_output(arguments.json, json + "\n  ]\n}\n");
}

}  // namespace

int run_learn(const LearnArguments& arguments) {
  const auto done = learn(arguments);
  return done ? 0 : report_failure(kProgram, done.error());
}

}  // namespace zonepack
