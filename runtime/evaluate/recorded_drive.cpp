// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/recorded_drive.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {
namespace {

// The part of a list that a cycle brought; `begin` moves on to its end.
template <typename T>
std::span<const T> next_part(const std::vector<T>& all, std::size_t& begin, std::size_t end) {
  const std::span<const T> part(all.data() + begin, end - begin);
  begin = end;
  return part;
}

class CyclesDrive {
 public:
  CyclesDrive(const Drive& drive, const CyclesInput& input, std::shared_ptr<MapVersion> map)
      : drive_(drive),
        input_(input),
        loader_(map->catalog(), map->model().slots, input.terms.rates, nullptr),
        run_({.cycle = input.cycle,
              .terms = input.terms,
              .keep_trace = input.keep_trace,
              .eviction = input.eviction},
             std::move(map)) {
    run_.add_observer(input_.observer);
  }

  Outcome<ReplayResult> drive() {
    if (const auto opened = run_.open({.loader = loader_}); !opened) return opened.error();
    if (drive_.start) run_.start_at(*drive_.start);
    for (const Drive::Cycle& cycle : drive_.cycles) step(cycle);
    run_.end();
    ReplayResult result;
    result.summary = run_.summarise(loader_.bytes_loaded(), drive_.frames.size());
    if (input_.keep_trace) result.trace = run_.take_trace();
    return result;
  }

 private:
  void step(const Drive::Cycle& cycle) {
    loader_.advance_to(cycle.now_ns);
    loads_.clear();
    while (const auto load = loader_.poll()) loads_.push_back(*load);
    commands_.clear();
    for (const Drive::NamedCommand& named : next_part(drive_.commands, command_, cycle.commands)) {
      if (named.command.kind == Command::Kind::kRouteHint && !input_.takes_route) continue;
      if (const auto command = on_map(named, input_.catalog)) commands_.push_back(*command);
    }
    run_.step({.now_ns = cycle.now_ns,
               .frames = next_part(drive_.frames, frame_, cycle.frames),
               .corrections = next_part(drive_.corrections, correction_, cycle.corrections),
               .loads = loads_,
               .commands = commands_,
               .edges = next_part(drive_.edges, edge_, cycle.edges)});
  }

  const Drive& drive_;
  const CyclesInput& input_;
  ModelledLoader loader_;
  Run run_;
  std::vector<LoadResult> loads_;
  std::vector<Command> commands_;
  std::size_t frame_ = 0, correction_ = 0, command_ = 0, edge_ = 0;
};

}  // namespace

Outcome<ReplayResult> replay_cycles(const Drive& drive, const CyclesInput& input) {
  auto map = MapVersion::make(1, input.catalog, input.terms);
  if (!map) return map.error();
  return CyclesDrive(drive, input, std::move(*map)).drive();
}

}  // namespace zonepack
