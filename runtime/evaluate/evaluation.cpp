// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/evaluation.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "runtime/evaluate/known_route.hpp"
#include "runtime/evaluate/order_trace.hpp"
#include "runtime/evaluate/recorded_drive.hpp"
#include "runtime/replay/replay.hpp"

namespace zonepack {
namespace {

class FrameList final : public CanFrameSource {
 public:
  explicit FrameList(std::span<const CanFrame> frames) : frames_(frames) {}
  std::optional<CanFrame> next() noexcept override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }

 private:
  std::span<const CanFrame> frames_;
  std::size_t next_ = 0;
};

EvictionOrderMaker maker_of(const Choice& choice, OrderTrace& trace) {
  const EvictionOrderMaker& make = choice.eviction->make;
  if (choice.order_trace) {
    return [&trace, make](const EvictionPlace& place) { return traced(make(place), trace); };
  }
  // As the robot runs it.
  return choice.eviction == eviction_policies().data() ? EvictionOrderMaker() : make;
}

// As the robot of this drive would give them, had it known its way.
Outcome<std::vector<TimedCommand>> known_route(const Evaluation& evaluation, Choice choice) {
  const EvaluatedMap& map = evaluation.maps[choice.map];
  const Drive& drive = evaluation.drives[choice.drive];
  choice.eviction = find_eviction("lru");
  choice.preload = find_preload("portal");
  FrameList frames(drive.frames);
  ReplayInput input{map.catalog, frames};
  input.corrections = drive.corrections;
  input.commands = map.commands[choice.drive];
  input.cycle = cycle_config(evaluation.settings);
  choice.preload->choose(input.cycle);
  input.most_frames = evaluation.settings.cycle.most_frames;
  input.terms = terms_of(evaluation, choice);
  input.load_packs = false;
  ZonesEntered zones;
  input.observer = &zones;
  if (const auto done = replay(std::move(input)); !done) return done.error();
  return hints_of(zones, drive.frames.empty() ? 0 : drive.frames.front().stamp_ns);
}

Outcome<ReplayResult> drive_log(const Evaluation& evaluation, const Choice& choice,
                                const MapTerms& terms, RunObserver& account, OrderTrace& trace) {
  const EvaluatedMap& map = evaluation.maps[choice.map];
  const Drive& drive = evaluation.drives[choice.drive];
  FrameList frames(drive.frames);
  ReplayInput input{map.catalog, frames};
  input.corrections = drive.corrections;
  input.commands = map.commands[choice.drive];
  if (choice.preload->knows_route) {
    auto hints = known_route(evaluation, choice);
    if (!hints) return hints.error();
    std::vector<TimedCommand> all;
    std::ranges::merge(input.commands, *hints, std::back_inserter(all), {},
                       &TimedCommand::received_ns, &TimedCommand::received_ns);
    input.commands = std::move(all);
  }
  input.truth = drive.truth ? &*drive.truth : nullptr;
  input.cycle = cycle_config(evaluation.settings);
  choice.preload->choose(input.cycle);
  input.most_frames = evaluation.settings.cycle.most_frames;
  input.terms = terms;
  input.load_packs = false;
  input.observer = &account;
  input.eviction = maker_of(choice, trace);
  input.keep_trace = choice.curves;
  return replay(std::move(input));
}

Outcome<ReplayResult> drive_recording(const Evaluation& evaluation, const Choice& choice,
                                      const MapTerms& terms, RunObserver& account,
                                      OrderTrace& trace) {
  CycleConfig cycle = cycle_config(evaluation.settings);
  choice.preload->choose(cycle);
  return replay_cycles(evaluation.drives[choice.drive],
                       {.catalog = evaluation.maps[choice.map].catalog,
                        .cycle = cycle,
                        .terms = terms,
                        .observer = account,
                        .eviction = maker_of(choice, trace),
                        .keep_trace = choice.curves,
                        .takes_route = choice.preload->takes_route});
}

BoundPlace place_of(const MapModel& model, std::vector<ZoneWeight>& weights) {
  for (ZoneId zone = 0; zone < model.needs.size(); ++zone) {
    weights.push_back({model.needs[zone], model.catalog.zones[zone].stored_bytes});
  }
  const ResidencyLimits& limits = model.limits;
  const std::uint32_t slots =
      Residency::slots_within(limits.budget, limits.fixed, limits.slot_bytes);
  return {weights, std::min(slots, limits.most_slots), limits.max_signatures};
}

}  // namespace

MapTerms terms_of(const Evaluation& evaluation, const Choice& choice) {
  RunChoices choices;
  choices.budget = choice.budget;
  choices.max_signatures = choice.max_signatures;
  choices.storage_rate = choice.storage_rate;
  MapTerms terms = map_terms(choices, evaluation.settings, evaluation.learned);
  terms.budget = choice.budget;
  terms.eviction = choice.eviction->rule;
  terms.habits = choice.preload->by_habits || terms.eviction == EvictionRule::kExpected;
  if (!terms.habits) terms.learned = nullptr;
  return terms;
}

Outcome<Evaluated> evaluate(const Evaluation& evaluation, const Choice& choice) {
  const EvaluatedMap& map = evaluation.maps[choice.map];
  const Drive& drive = evaluation.drives[choice.drive];
  const auto named = [&](const Failure& cause) {
    return Failure{cause.code, map.name + ", " + drive.files.name() + ": " + cause.message};
  };
  const MapTerms terms = terms_of(evaluation, choice);
  const Catalog catalog = charged_on(map.catalog, terms);
  const auto model = MapModel::make(catalog, terms);
  if (!model) return named(model.error());
  DriveAccount account(**model, terms.rates);
  OrderTrace trace;
  auto replayed = drive.recorded() ? drive_recording(evaluation, choice, terms, account, trace)
                                   : drive_log(evaluation, choice, terms, account, trace);
  if (!replayed) return named(replayed.error());
  account.end();

  std::vector<ZoneWeight> weights;
  const BoundPlace place = place_of(**model, weights);
  Evaluated result;
  result.summary = std::move(replayed->summary);
  result.requests = account.requests();
  result.hits = account.hits();
  result.entered = account.entered();
  result.bytes_read = account.bytes_read();
  result.bytes_unused = account.bytes_unused();
  result.foreseen = account.foreseen();
  result.farthest = evict_farthest(account.steps(), place);
  result.least = least_loads(account.steps(), place);
  result.trace = std::move(replayed->trace);
  if (choice.order_trace) {
    std::vector<std::string> names;
    for (const CatalogZone& zone : map.catalog.zones) names.push_back(zone.name);
    result.order_csv = trace.csv(names);
  }
  return result;
}

}  // namespace zonepack
