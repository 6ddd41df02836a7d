// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/evaluate_totals.hpp"

#include <algorithm>
#include <filesystem>

namespace zonepack {
namespace {

bool same_terms(const Choice& a, const Choice& b) {
  return a.map == b.map && a.budget == b.budget && a.max_signatures == b.max_signatures &&
         a.eviction == b.eviction && a.preload == b.preload && a.storage_rate == b.storage_rate;
}

void add(LoadTotals& all, const LoadTotals& more) {
  all.loads += more.loads;
  all.signatures += more.signatures;
  all.bytes += more.bytes;
}

}  // namespace

std::vector<Totals> totals_of(const std::vector<Choice>& choices,
                              const std::vector<Evaluated>& results) {
  std::vector<Totals> all;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    auto known = std::ranges::find_if(
        all, [&](const Totals& totals) { return same_terms(totals.choice, choices[i]); });
    const Evaluated& result = results[i];
    const RunSummary& summary = result.summary;
    if (known == all.end()) {
      known = all.emplace(known);
      known->choice = choices[i];
      known->budget_bytes = summary.budget_bytes;
    }
    Totals& totals = *known;
    ++totals.runs;
    totals.loads += summary.zones_loaded;
    totals.signatures += summary.signatures_loaded;
    totals.requests += result.requests;
    totals.hits += result.hits;
    totals.bytes_read += result.bytes_read;
    totals.bytes_unused += result.bytes_unused;
    totals.absent_s += summary.localised ? summary.zone_absent_s : 0;
    totals.blocked_s += summary.blocked_s;
    totals.never_localised += !summary.localised;
    totals.foreseen.changes += result.foreseen.changes;
    totals.foreseen.first += result.foreseen.first;
    totals.foreseen.first_two += result.foreseen.first_two;
    add(totals.farthest, result.farthest);
    add(totals.least, result.least);
  }
  return all;
}

std::string short_name(const std::string& path) {
  std::filesystem::path place = std::filesystem::path(path).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  const std::string folder = place.parent_path().filename().string();
  const std::string name = place.filename().string();
  // Logs are often named alike, in folders that are not.
  return name.find(".log") == std::string::npos || folder.empty() ? name : folder + "/" + name;
}

}  // namespace zonepack
