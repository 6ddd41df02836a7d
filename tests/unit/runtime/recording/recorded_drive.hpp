// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "platform/can/can_log.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/recording/input_tap.hpp"
#include "runtime/recording/input_writer.hpp"
#include "runtime/recording/preface.hpp"
#include "runtime/replay/recorded_run.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/inputs/run_inputs.hpp"
#include "runtime/run/maps/map_model.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "tests/support/sample_catalog.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::testing_support {

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The paper's loop through the sample building, driven as a robot would be: cycles come late or are
// skipped, readers hold zones, people pin and freeze, loads fail and are cancelled, lines change.
// The seed decides what happens when.
class RecordedDrive {
 public:
  RecordedDrive()
      : text_(with_lines(text_of(std::string(ZONEPACK_SOURCE_DIR) + "/config/agilex.yaml"))),
        run_{parse_settings(text_, "agilex.yaml").settings,
             sample_catalog(std::string(ZONEPACK_TEST_DATA) + "/zones.geojson", 3)} {
    RunChoices choices;
    choices.storage_rate = 500'000;
    terms_ = map_terms(choices, run_.settings, nullptr);
    terms_.lease_ns = 500'000'000;
    terms_.budget = run_.catalog.smallest().bytes + 5 * kMiB / 2;
  }

  const RecordedRun& run() const { return run_; }

  RecordingPreface preface() const {
    RecordingPreface preface;
    preface.program = "test";
    preface.settings_path = "agilex.yaml";
    preface.settings = text_;
    preface.map_folder = "sample";
    preface.manifest = {std::byte{1}};
    preface.terms = terms_;
    return preface;
  }

  // Called after each cycle's inputs are in the tap: may drain it or look at it.
  using AfterCycle = std::function<void(std::uint64_t cycle, InputWriter& writer)>;

  // A stretch of the drive on which the robot is lost: its localizer says so, has a zone loaded
  // ten cycles later and gives no fix before the end.
  struct LostStretch {
    std::uint64_t from = 0, until = 0;
    ZoneId sought = kNoZone;
  };
  std::optional<LostStretch> lost;

  // Drives, and writes the events to a file. file and flight may be null. Returns the hash of the
  // events.
  std::string drive(std::uint64_t seed, const std::string& events, RecordingFile* file,
                    FlightRecorder* flight, const AfterCycle& after_cycle = {}) {
    std::mt19937_64 random(seed);
    const auto made = MapModel::make(run_.catalog, terms_);
    if (!made) throw std::runtime_error(made.error().message);
    const MapModel* const map = made->get();
    Residency memory(map->needs.size(), map->limits);
    if (!map->pin(memory)) throw std::runtime_error("pins");
    SometimesFailing filler(random);
    ModelledLoader loader(run_.catalog, map->slots, terms_.rates, &filler);
    EventLog log([&](ZoneId zone) { return std::string_view(map->graph.name(zone)); });
    if (!log.write_to(events)) throw std::runtime_error(events);

    InputTap tap(64);
    InputWriter writer(tap, terms_.period_ns, map->needs.size(), file, flight);
    Told told{log, writer, words};
    Cycle cycle(cycle_config(run_.settings),
                {map->graph, map->needs, map->load_s, map->pinned, memory, loader, told});
    tap.follow(cycle.state());

    const std::string folder = std::string(ZONEPACK_TEST_DATA) + "/scenario1_loop/";
    CanLogReader can(folder + "can0.log");
    if (!can.open()) throw std::runtime_error("can0.log");
    SimCanBus bus(&can);
    const auto corrections = read_corrections(folder + "corrections.txt");
    std::size_t taken = 0;
    std::vector<CanFrame> frames(64);
    std::vector<Lease> leases;
    std::vector<LoadResult> loads;
    std::mt19937_64 hand(seed);  // on the lines
    bool held = false;
    std::int64_t nominal_ns = *bus.next_arrival_ns();
    for (std::uint64_t number = 0; bus.next_arrival_ns(); ++number) {
      const std::int64_t now_ns =
          nominal_ns + (random() % 8 == 0 ? static_cast<std::int64_t>(random() % 2'000'000) : 0);
      nominal_ns += terms_.period_ns * (random() % 500 == 0 ? 3 : 1);
      bus.advance_to(now_ns);
      loader.advance_to(now_ns);
      const std::size_t count = bus.receive(frames);
      const std::size_t first = taken;
      while (taken < corrections->size() && (*corrections)[taken].received_ns <= now_ns) ++taken;
      loads.clear();
      while (const auto load = loader.poll()) loads.push_back(*load);
      std::vector<Command> commands = made_up(random, map->needs.size(), leases);
      std::size_t fixes = taken - first;
      if (lost && number >= lost->from && number < lost->until) {
        fixes = 0;
        commands.clear();
        if (number == lost->from) commands.emplace_back().kind = Command::Kind::kLost;
        if (number == lost->from + 10) {
          commands.emplace_back().kind = Command::Kind::kSeek;
          commands.back().zone = lost->sought;
        }
      }
      std::vector<LineEdge> edges;
      if (hand() % 400 == 0) edges.push_back({now_ns - 1000, LineEdge::kHold, held = !held});
      if (hand() % 300 == 0) edges.push_back({now_ns, LineEdge::kFirstMarker, hand() % 3 != 0});
      if (number % 2500 == 2000) edges.push_back({now_ns - 30'000'000, LineEdge::kDock, true});
      if (number % 2500 == 2010) edges.push_back({now_ns, LineEdge::kDock, false});
      const CycleInput input{
          now_ns, {frames.data(), count}, {corrections->data() + first, fixes}, loads, commands, {},
          edges};
      const std::int64_t offset_ns = 1000 + static_cast<std::int64_t>(number / 1000);
      tap.on_inputs(number, input, offset_ns);
      cycle.run(input);
      for (const CommandReply& reply : cycle.replies()) {
        if (reply.lease.zone != kNoZone) leases.push_back(reply.lease);
      }
      if (after_cycle) {
        after_cycle(number, writer);
      } else {
        writer.drain(now_ns);
      }
    }
    cycle.finish();
    writer.flush();
    ZP_REQUIRE(log.close().ok());
    const std::string hash = log.hash();
    if (file != nullptr) {
      RecordingEnd end = writer.end();
      end.event_log_hash = hash;
      if (!file->finish(end)) throw std::runtime_error("finish");
    }
    return hash;
  }

  std::set<std::string> words;  // of all events so far

 private:
  // The example's lines, which are comments there.
  static std::string with_lines(std::string text) {
    for (const std::string key :
         {"dock: {chip", "hold: {chip", "zone_markers:", "  kitchen_door: {"}) {
      text.replace(text.find("# " + key), 2 + key.size(), key);
    }
    return text;
  }

  struct Told final : EventSink {
    Told(EventSink& to_log, InputWriter& to_writer, std::set<std::string>& seen)
        : log(to_log), writer(to_writer), words(seen) {}
    void on_event(const Event& event) noexcept override {
      log.on_event(event);
      writer.on_event(event);
      words.insert(to_string(event.kind));
    }
    EventSink& log;
    InputWriter& writer;
    std::set<std::string>& words;
  };

  struct SometimesFailing final : ZoneFiller {
    explicit SometimesFailing(std::mt19937_64& engine) : random(engine) {}
    Result<void> fill(ZoneId, std::span<const SlotIndex>) override {
      if (random() % 6 == 0) return {ErrorCode::kIo, 5};
      return {};
    }
    std::mt19937_64& random;
  };

  static std::vector<Command> made_up(std::mt19937_64& random, std::size_t zones,
                                      std::vector<Lease>& leases) {
    std::vector<Command> commands;
    if (random() % 60 != 0) return commands;
    for (std::size_t count = 1 + random() % 3; count > 0; --count) {
      Command& command = commands.emplace_back();
      command.kind = static_cast<Command::Kind>(random() % 7);
      if (command.kind == Command::Kind::kFreeze && random() % 4 != 0) {
        command.kind = Command::Kind::kUnfreeze;
      }
      command.id = random();
      command.zone = static_cast<ZoneId>(random() % (zones + 1));
      if (command.kind == Command::Kind::kRelease && !leases.empty()) {
        command.lease = leases.back();
        leases.pop_back();
      }
      if (command.kind == Command::Kind::kRouteHint) {
        command.route_length = static_cast<std::uint32_t>(random() % 5);
        for (std::uint32_t i = 0; i < command.route_length; ++i) {
          command.route[i] = static_cast<ZoneId>(random() % zones);
        }
      }
    }
    return commands;
  }

  std::string text_;
  RecordedRun run_;
  MapTerms terms_;
};

// A drive, a folder, and what replaying a recording of the drive there gives.
class ReplaysADrive : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder / name; }

  // Null: `fault` says why. Its events are in again.jsonl.
  std::optional<RecordedRunResult> replay(const std::string& recording) {
    auto reader = RecordingReader::open(recording);
    if (!reader) {
      fault = reader.error().message;
      return std::nullopt;
    }
    auto result = replay_recording(*reader, drive.run(), path("again.jsonl"));
    note = reader->note();
    if (result) return std::move(*result);
    fault = result.error().message;
    return std::nullopt;
  }

  test_support::TemporaryFolder folder;
  RecordedDrive drive;
  std::string fault, note;
};

}  // namespace zonepack::testing_support
