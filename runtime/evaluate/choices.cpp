// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/choices.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "runtime/pack_format/file/accounting.hpp"
#include "runtime/run/maps/map_model.hpp"

namespace zonepack {
namespace {

constexpr std::uint64_t kAutoSteps = 7;

std::vector<std::optional<ByteCount>> budgets_of(const EvaluateArguments& arguments,
                                                 const Settings& settings, const Catalog& catalog,
                                                 const std::vector<std::uint64_t>& limits) {
  std::vector<ByteCount> budgets = arguments.budgets;
  if (!arguments.auto_budgets) {
    if (!budgets.empty()) return {budgets.begin(), budgets.end()};
    if (settings.memory.budget) return {settings.memory.budget};
    const bool limited = std::ranges::none_of(limits, [](auto limit) { return limit == 0; });
    if (limited) return {std::nullopt};
  }
  std::vector<ZoneId> pinned;  // unknown names are refused later
  for (const std::string& name : settings.memory.pinned) {
    if (const ZoneId zone = catalog.find(name); zone != kNoZone) pinned.push_back(zone);
  }
  for (const ByteCount budget : auto_budgets(catalog, pinned)) budgets.push_back(budget);
  std::ranges::sort(budgets);
  budgets.erase(std::unique(budgets.begin(), budgets.end()), budgets.end());
  return {budgets.begin(), budgets.end()};
}

template <typename T>
std::vector<T> or_else(const std::vector<T>& given, T otherwise) {
  return given.empty() ? std::vector<T>{std::move(otherwise)} : given;
}

}  // namespace

std::vector<ByteCount> auto_budgets(const Catalog& catalog, const std::vector<ZoneId>& pinned) {
  const ByteCount least = catalog.smallest(pinned).bytes;
  std::uint64_t slots = 0;
  for (const CatalogZone& zone : catalog.zones) slots += zone.slots;
  const ByteCount whole = std::max(charged_with(catalog.fixed_bytes, slots), least);
  const ByteCount slot = kSlotBytes + kTableBytesPerSlot;
  std::vector<ByteCount> budgets;
  for (std::uint64_t step = 0; step <= kAutoSteps; ++step) {
    const ByteCount budget = least + (whole - least) / slot * step / kAutoSteps * slot;
    if (budgets.empty() || budget > budgets.back()) budgets.push_back(budget);
  }
  return budgets;
}

namespace {

// With all tables that one of them holds, so that automatic budgets do for each.
MapTerms widest_terms(const std::vector<std::string>& evictions,
                      const std::vector<std::string>& preloads) {
  MapTerms terms;
  for (const std::string& name : evictions) {
    const EvictionRule rule = find_eviction(name)->rule;
    if (rule != EvictionRule::kLru) terms.eviction = rule;
  }
  terms.habits = terms.eviction == EvictionRule::kExpected;
  for (const std::string& name : preloads) terms.habits |= find_preload(name)->by_habits;
  return terms;
}

Outcome<void> check_held(const Evaluation& evaluation, const Choice& choice) {
  const EvaluatedMap& map = evaluation.maps[choice.map];
  const MapTerms terms = terms_of(evaluation, choice);
  const Catalog catalog = charged_on(map.catalog, terms);
  const auto held = MapModel::make(catalog, terms);
  if (!held) return Failure{held.error().code, map.name + ": " + held.error().message};
  return {};
}

}  // namespace

Outcome<std::vector<Choice>> choices_of(const EvaluateArguments& arguments,
                                        const Evaluation& evaluation) {
  const Settings& settings = evaluation.settings;
  const auto limits = or_else(arguments.max_signatures, settings.memory.max_signatures);
  const auto evictions = or_else<std::string>(
      arguments.evictions,
      settings.memory.eviction == EvictionRule::kExpected ? "expected" : "lru");
  const auto preloads = or_else<std::string>(
      arguments.preloads, uses_habits(settings.preload) ? "transitions" : "portal");
  const auto rates = or_else(arguments.storage_rates,
                             static_cast<std::uint64_t>(settings.loading.expected_storage_rate()));
  std::vector<Choice> all;
  Choice choice;
  choice.order_trace = !arguments.trace_csv.empty();
  for (choice.map = 0; choice.map < evaluation.maps.size(); ++choice.map) {
    const EvaluatedMap& map = evaluation.maps[choice.map];
    const auto budgets = budgets_of(
        arguments, settings, charged_on(map.catalog, widest_terms(evictions, preloads)), limits);
    for (const std::uint64_t limit : limits) {
      for (const auto& budget : budgets) {
        choice.budget = budget;
        choice.max_signatures = limit;
        choice.storage_rate = rates.front();
        for (const std::string& eviction : evictions) {
          choice.eviction = find_eviction(eviction);
          for (const std::string& preload : preloads) {
            choice.preload = find_preload(preload);
            if (auto held = check_held(evaluation, choice); !held) return held.error();
          }
        }
      }
    }
    for (choice.drive = 0; choice.drive < evaluation.drives.size(); ++choice.drive) {
      for (const auto& budget : budgets) {
        choice.budget = budget;
        for (const std::uint64_t limit : limits) {
          choice.max_signatures = limit;
          for (const std::string& eviction : evictions) {
            choice.eviction = find_eviction(eviction);
            for (const std::string& preload : preloads) {
              choice.preload = find_preload(preload);
              for (const std::uint64_t rate : rates) {
                choice.storage_rate = rate;
                // The report draws over time the first of each choice but maps and evictions.
                choice.curves = !arguments.report.empty() && budget == budgets.front() &&
                                limit == limits.front() && preload == preloads.front() &&
                                rate == rates.front();
                all.push_back(choice);
              }
            }
          }
        }
      }
    }
  }
  return all;
}

}  // namespace zonepack
