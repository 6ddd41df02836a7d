// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "platform/base/require.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/replay/pack_filler.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {
namespace {

// Feeds a log to a run.
class LogDrive {
 public:
  LogDrive(ReplayInput& input, std::shared_ptr<MapVersion> map)
      : input_(input),
        filler_(input.load_packs ? std::make_unique<PackFiller>(map->catalog(), map->model().slots)
                                 : nullptr),
        loader_(map->catalog(), map->model().slots, input.terms.rates, filler_.get()),
        resident_(filler_.get()),
        bus_(&input.frames),
        run_({.cycle = input.cycle,
              .terms = input.terms,
              .truth = input.truth,
              .events = input.events_path,
              .keep_trace = input.keep_trace,
              .eviction = input.eviction},
             std::move(map)) {
    if (input_.observer != nullptr) run_.add_observer(*input_.observer);
  }

  Outcome<ReplayResult> drive();

 private:
  void run_cycles(std::int64_t start_ns);
  RunPorts ports() {
    RunPorts ports{.loader = loader_};
    if (input_.fixes != nullptr) ports.directory = &resident_;
    return ports;
  }
  void ask_for_fixes(std::int64_t now_ns, std::size_t taken);
  void take_commands(std::int64_t now_ns);

  ReplayInput& input_;
  std::unique_ptr<PackFiller> filler_;
  ModelledLoader loader_;
  ResidentZones resident_;
  SimCanBus bus_;
  Run run_;
  std::vector<PoseCorrection> new_fixes_;
  std::vector<TimedCommand> new_commands_;
  std::vector<Command> commands_;  // of this cycle
  std::size_t commands_taken_ = 0;
  std::uint64_t frames_ = 0;
};

Outcome<ReplayResult> LogDrive::drive() {
  const auto first_ns = bus_.next_arrival_ns();
  if (!first_ns) return failure("the CAN log holds no frame");
  if (const auto opened = run_.open(ports()); !opened) return opened.error();
  const auto start = find_start(input_.start, input_.truth, *first_ns);
  if (!start) return start.error();
  if (*start) run_.start_at(**start);
  run_cycles(*first_ns);
  run_.end();

  ReplayResult result;
  result.summary = run_.summarise(loader_.bytes_loaded(), frames_);
  result.events_written = run_.close_events();
  if (input_.keep_trace) result.trace = run_.take_trace();
  if (filler_) result.faults = filler_->faults();
  return result;
}

void LogDrive::run_cycles(std::int64_t start_ns) {
  std::vector<CanFrame> frames(input_.most_frames);
  std::vector<LoadResult> loads;
  const std::vector<PoseCorrection>& corrections = input_.corrections;
  std::size_t taken = 0;
  for (std::int64_t now_ns = start_ns;; now_ns += input_.terms.period_ns) {
    bus_.advance_to(now_ns);
    loader_.advance_to(now_ns);
    const std::size_t count = bus_.receive(frames);
    frames_ += count;
    std::size_t end = taken;
    while (end < corrections.size() && corrections[end].received_ns <= now_ns) ++end;
    take_commands(now_ns);
    loads.clear();
    while (const auto load = loader_.poll()) loads.push_back(*load);
    run_.step({.now_ns = now_ns,
               .frames = {frames.data(), count},
               .corrections = {corrections.data() + taken, end - taken},
               .loads = loads,
               .commands = commands_});
    taken = end;
    if (input_.fixes != nullptr) ask_for_fixes(now_ns, taken);
    if (!bus_.next_arrival_ns()) return;
  }
}

// Of more than fit in a cycle the rest waits.
void LogDrive::take_commands(std::int64_t now_ns) {
  commands_.clear();
  const std::vector<TimedCommand>& all = input_.commands;
  while (commands_taken_ < all.size() && all[commands_taken_].received_ns <= now_ns &&
         commands_.size() < Cycle::kMostCommands) {
    commands_.push_back(all[commands_taken_++].command);
  }
}

// Corrections up to `taken` are past.
void LogDrive::ask_for_fixes(std::int64_t now_ns, std::size_t taken) {
  new_fixes_.clear();
  input_.fixes->after_cycle({now_ns, run_.switcher().map().cycle.state(), resident_}, new_fixes_);
  std::vector<PoseCorrection>& all = input_.corrections;
  for (const PoseCorrection& fix : new_fixes_) {
    ZP_REQUIRE(fix.received_ns > now_ns);
    const auto later = [](std::int64_t t_ns, const PoseCorrection& other) {
      return t_ns < other.received_ns;
    };
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(taken);
    all.insert(std::upper_bound(first, all.end(), fix.received_ns, later), fix);
  }
  new_commands_.clear();
  input_.fixes->command({now_ns, run_.switcher().map().cycle.state(), resident_}, new_commands_);
  for (const TimedCommand& command : new_commands_) {
    ZP_REQUIRE(command.received_ns > now_ns);
    const auto first = input_.commands.begin() + static_cast<std::ptrdiff_t>(commands_taken_);
    input_.commands.insert(std::upper_bound(first, input_.commands.end(), command.received_ns,
                                            [](std::int64_t t_ns, const TimedCommand& other) {
                                              return t_ns < other.received_ns;
                                            }),
                           command);
  }
}

}  // namespace

Outcome<ReplayResult> replay(ReplayInput input) {
  auto map = MapVersion::make(1, input.catalog, input.terms);
  if (!map) return map.error();
  const std::optional<std::string> warning = (*map)->model().warning;
  auto result = LogDrive(input, std::move(*map)).drive();
  if (result && warning) result->warnings.push_back(*warning);
  return result;
}

}  // namespace zonepack
