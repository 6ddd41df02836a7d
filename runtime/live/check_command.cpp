// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/check_command.hpp"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <vector>

#include "platform/base/counted.hpp"
#include "platform/base/failure.hpp"
#include "platform/devices/board.hpp"
#include "platform/files/output_place.hpp"
#include "platform/memory/account.hpp"
#include "platform/memory/shared_memory.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/bus/live_source.hpp"
#include "runtime/live/gpio/line_requests.hpp"
#include "runtime/map/load_fault.hpp"
#include "runtime/map/loader.hpp"
#include "runtime/memory/shared_layout.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/maps/map_model.hpp"
#include "runtime/settings/socket_place.hpp"

namespace zonepack {
namespace {

constexpr ByteCount kOverhead =
    12 * kMiB;  // runtime/README.md: what a run takes besides its budget

struct CheckRow {
  enum class Kind { kGood, kWeak, kRefused };
  Kind kind = Kind::kGood;
  std::string name, found, mend;
};

class Check {
 public:
  explicit Check(const RunArguments& arguments) : arguments_(arguments) {}

  int run() {
    if (settings_and_map() && budget()) {
      packs();
      memory();
      socket();
    }
    outputs();
    source();
    lines();
    scheduler();
    board();
    return print();
  }

 private:
  void good(std::string name, std::string found) {
    rows_.push_back({CheckRow::Kind::kGood, std::move(name), std::move(found), ""});
  }
  void refuse(std::string name, std::string found, std::string mend = "") {
    rows_.push_back({CheckRow::Kind::kRefused, std::move(name), std::move(found), std::move(mend)});
  }
  // What --allow-degraded goes on without.
  void refuse_privilege(std::string name, std::string found, std::string mend) {
    rows_.push_back({arguments_.allow_degraded ? CheckRow::Kind::kWeak : CheckRow::Kind::kRefused,
                     std::move(name), std::move(found), std::move(mend)});
  }

  bool settings_and_map() {
    auto inputs = read_run_inputs(arguments_);
    if (!inputs) {
      refuse("settings and map", inputs.error().message);
      return false;
    }
    inputs_ = std::move(*inputs);
    good("settings", arguments_.config);
    for (const std::string& text : inputs_.warnings) {
      rows_.push_back({CheckRow::Kind::kWeak, "settings", text, ""});
    }
    good("map", inputs_.catalog.folder + ", " + counted(inputs_.catalog.zones.size(), "zone"));
    return true;
  }

  bool budget() {
    const MapTerms terms = map_terms(arguments_, inputs_);
    const ByteCount habits = extra_fixed_bytes(inputs_.catalog, terms);
    inputs_.catalog = charged_on(std::move(inputs_.catalog), terms);
    auto model = MapModel::make(inputs_.catalog, terms);
    if (!model) {
      refuse("budget", model.error().message);
      return false;
    }
    map_ = std::move(*model);
    if (map_->warning) {
      rows_.push_back({CheckRow::Kind::kWeak, "budget", *map_->warning, "see zonepack plan"});
    } else {
      good("budget",
           short_bytes(map_->limits.budget) + " (" + counted(map_->limits.budget, "byte") + ")");
    }
    if (habits > 0) {
      good("transitions", counted(habits, "byte") + " of the budget, for what zones come next");
    }
    Residency trial(map_->needs.size(), map_->limits);
    if (const auto pinned = map_->pin(trial); !pinned) {
      refuse("pinned zones", pinned.error().message);
    }
    return true;
  }

  void packs() {
    for (ZoneId zone = 0; zone < inputs_.catalog.zones.size(); ++zone) {
      const auto pack = open_pack(inputs_.catalog, zone);
      if (pack) continue;
      refuse("packs", load_fault(inputs_.catalog, zone, pack.error()));
      return;
    }
    good("packs", counted(inputs_.catalog.zones.size(), "pack") + ", all there at full length");
  }

  void memory() {
    const auto zones = static_cast<std::uint32_t>(map_->needs.size());
    const auto memory = SharedMemory::create("zoned-check", shared_map_bytes(zones, map_->slots));
    if (!memory) {
      refuse("memory", reason_text(memory.error()), "allow less by memory.budget");
      return;
    }
    good("memory", short_bytes(memory->read_only().size()) + " reserved for a moment");
    if (!inputs_.settings.realtime.lock_memory) return;
    const auto locked = lock_memory_now();
    if (locked) {
      good("memory lock", "granted");
    } else {
      refuse_privilege("memory lock", reason_text(locked.error()),
                       "LimitMEMLOCK=infinity in the unit, or realtime.lock_memory: false");
    }
    unlock_memory();
  }

  // Where others are served. A folder that is missing is made by the run, in one that is there.
  void socket() {
    const ServeSettings& serve = inputs_.settings.serve;
    const std::string path = listening_socket(arguments_.socket, serve);
    if (path.empty()) return good("socket", "none: nobody is served");
    const std::string folder = folder_of_path(path);
    auto possible = check_output_place(path);
    if (!possible && possible.error().code == ErrorCode::kNotFound) {
      possible = check_output_place(folder);
    }
    if (!possible) {
      return refuse("socket", path + ": cannot be made in " + folder,
                    "make the folder, or name another place: serve.socket, --socket PATH");
    }
    if (!serve.group.empty() && !group_number(serve.group)) {
      return refuse("socket", path + ": there is no group \"" + serve.group + "\"",
                    "groupadd --system " + serve.group + ", or another serve.group");
    }
    good("socket", path);
  }

  void outputs() {
    const auto possible = check_run_outputs(arguments_);
    if (!possible) refuse("outputs", possible.error().message);
  }

  void source() {
    using Kind = CanSourceChoice::Kind;
    const Kind kind = arguments_.source.kind;
    const char* const name = kind == Kind::kLog      ? "CAN log"
                             : kind == Kind::kScript ? "CAN script"
                                                     : "CAN bus";
    const SpscQueue<LiveNote> notes(1);
    const auto source = LiveSource::open({.choice = arguments_.source,
                                          .settings = inputs_.settings,
                                          .corrections = {},
                                          .period_ns = 1'000'000,
                                          .notes = notes,
                                          .allow_degraded = false});
    if (!source && kind == Kind::kSocketCan) {
      refuse_privilege(name, source.error().message, "");
    } else if (!source) {
      refuse(name, source.error().message);
    } else if (const std::string warning = (*source)->warning(); !warning.empty()) {
      rows_.push_back({CheckRow::Kind::kWeak, name, warning, ""});
    } else {
      good(name, arguments_.source.name);
    }
    if (source && kind == Kind::kLog && map_) match_log();
  }

  // Whether the log holds what odometry reads.
  void match_log() {
    constexpr std::uint64_t kMostFrames = 1'000'000;
    CanLogReader log(arguments_.source.name, inputs_.settings.can.interface);
    if (!log.open()) return;
    LogMatch frames(log);
    for (std::uint64_t i = 0; i < kMostFrames && frames.next(); ++i) continue;
    const std::string mismatch =
        frames.mismatch(inputs_.settings.odometry.wheels, arguments_.source.name, log.summary());
    if (!mismatch.empty()) rows_.push_back({CheckRow::Kind::kWeak, "CAN frames", mismatch, ""});
  }

  void lines() {
    if (map_) {
      const auto fit = ZoneMarkers::check(map_->graph, cycle_config(inputs_.settings).markers);
      if (!fit) refuse("zone markers", fit.error().message);
    }
    for (LineFinding& line : inspect_lines(kernel_gpio(), inputs_.settings.gpio)) {
      if (line.fault.empty()) {
        good(std::move(line.name), std::move(line.found));
      } else {
        refuse_privilege(std::move(line.name), std::move(line.fault), "");
      }
    }
  }

  void scheduler() {
    const RealtimeSettings& realtime = inputs_.settings.realtime;
    const auto thread = Thread::start({.name = "zoned-check",
                                       .fifo_priority = static_cast<int>(realtime.priority),
                                       .cpu = realtime.cpu.empty() ? -1 : std::stoi(realtime.cpu)},
                                      false, [] {});
    if (thread) {
      good("scheduler", "SCHED_FIFO " + std::to_string(realtime.priority) + " granted");
    } else {
      refuse_privilege("scheduler", reason_text(thread.error()),
                       "LimitRTPRIO=" + std::to_string(realtime.priority) +
                           " in the unit, and a processor that exists in realtime.cpu");
    }
  }

  void board() {
    BoardNeeds needs;
    const RealtimeSettings& realtime = inputs_.settings.realtime;
    needs.priority = static_cast<int>(realtime.priority);
    if (!realtime.cpu.empty()) needs.cpu = static_cast<unsigned>(std::stoul(realtime.cpu));
    if (map_) needs.locked_bytes = map_->limits.budget + kOverhead;
    for (BoardFact& fact : inspect_board(needs)) {
      rows_.push_back({fact.good ? CheckRow::Kind::kGood : CheckRow::Kind::kWeak,
                       std::move(fact.name), std::move(fact.found), std::move(fact.mend)});
    }
  }

  int print() const {
    std::size_t width = 0;
    for (const CheckRow& row : rows_) width = std::max(width, row.name.size());
    std::size_t refused = 0, weak = 0;
    for (const CheckRow& row : rows_) {
      const bool no = row.kind == CheckRow::Kind::kRefused,
                 so_so = row.kind == CheckRow::Kind::kWeak;
      refused += no;
      weak += so_so;
      std::cout << (no      ? "REFUSED  "
                    : so_so ? "weak     "
                            : "ok       ")
                << row.name << std::string(width - row.name.size() + 2, ' ') << row.found << '\n';
      if (!row.mend.empty()) {
        std::cout << std::string(9 + width + 2, ' ') << "mend: " << row.mend << '\n';
      }
    }
    std::cout << (refused > 0 ? "The run would be refused" : "The run would start") << "; " << weak
              << " of " << rows_.size() << " things could be better.\n";
    return refused > 0 ? 1 : 0;
  }

  const RunArguments& arguments_;
  RunInputs inputs_;
  std::unique_ptr<MapModel> map_;
  std::vector<CheckRow> rows_;
};

}  // namespace

int check_run(const RunArguments& arguments) { return Check(arguments).run(); }

}  // namespace zonepack
