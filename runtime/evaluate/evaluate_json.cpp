// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/evaluate_json.hpp"

#include <algorithm>
#include <string_view>

#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"

namespace zonepack {
namespace {

constexpr std::string_view kMethod = "interval packing, relaxed to a flow";

std::string share_json(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "null";
  return shortest_number(static_cast<double>(part) / static_cast<double>(whole));
}

std::string totals_json(const LoadTotals& totals) {
  return "\"loads\": " + std::to_string(totals.loads) +
         ", \"signatures\": " + std::to_string(totals.signatures) +
         ", \"bytes\": " + std::to_string(totals.bytes);
}

std::string run_json(const Evaluation& evaluation, const Choice& choice, const Evaluated& result,
                     std::size_t number) {
  const RunSummary& s = result.summary;
  std::string text;
  const auto add = [&text](std::string_view key, const std::string& value) {
    text += (text.empty() ? "    {\"" : ",\n     \"") + std::string(key) + "\": " + value;
  };
  const auto count = [&add](std::string_view key, std::uint64_t value) {
    add(key, std::to_string(value));
  };
  add("map", json_quoted(evaluation.maps[choice.map].name));
  add("drive", json_quoted(evaluation.drives[choice.drive].files.name()));
  count("budget_bytes", s.budget_bytes);
  count("max_signatures", s.max_signatures);
  add("eviction", json_quoted(choice.eviction->name));
  add("preload", json_quoted(choice.preload->name));
  count("storage_rate", choice.storage_rate);
  count("loads", s.zones_loaded);
  count("unloads", s.zones_unloaded);
  count("zones", result.entered);
  count("signatures_loaded", s.signatures_loaded);
  count("signatures_unloaded", s.signatures_unloaded);
  count("requests", result.requests);
  count("hits", result.hits);
  count("bytes_read", result.bytes_read);
  count("bytes_read_unused", result.bytes_unused);
  add("zone_absent_s", s.localised ? shortest_number(s.zone_absent_s) : "null");
  add("blocked_s", shortest_number(s.blocked_s));
  const DriveAccount::Foreseen& foreseen = result.foreseen;
  const std::uint64_t judged = choice.preload->foresees ? foreseen.changes : 0;
  add("prediction", "{\"first\": " + share_json(foreseen.first, judged) +
                        ", \"first_two\": " + share_json(foreseen.first_two, judged) + "}");
  add("bounds", "{\"farthest\": {" + totals_json(result.farthest) +
                    "},\n                \"lower\": {" + totals_json(result.least) +
                    ", \"method\": " + json_quoted(kMethod) + "}}");
  count("peak_charged_bytes", s.peak_charged_bytes);
  count("budget_violations", s.budget_violations);
  add("event_log_hash", json_quoted(s.event_log_hash));
  if (choice.order_trace) add("trace", json_quoted(trace_file_name(number)));
  return text + "}";
}

// Columns as wide as their widest cell; all but the first two to the right.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  constexpr std::size_t kToTheLeft = 2;
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      const bool last = i + 1 == row.size();
      text += i < kToTheLeft ? row[i] + blanks : blanks + row[i];
      text += last ? "\n" : "  ";
    }
  }
  return text;
}

}  // namespace

std::string trace_file_name(std::size_t run) {
  std::string number = std::to_string(run);
  if (number.size() < 5) number.insert(0, 5 - number.size(), '0');
  return "run-" + number + ".csv";
}

std::string evaluation_json(const Evaluation& evaluation, const std::vector<Choice>& choices,
                            const std::vector<Evaluated>& results) {
  std::string text = "{\n  \"runs\": [";
  for (std::size_t i = 0; i < choices.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + run_json(evaluation, choices[i], results[i], i);
  }
  return text + "\n  ]\n}\n";
}

std::string evaluation_table(const Evaluation& evaluation, const std::vector<Choice>& choices,
                             const std::vector<Evaluated>& results) {
  std::vector<std::vector<std::string>> rows = {
      {"map", "drive", "budget MiB", "most", "eviction", "preload", "read/s", "zones", "loads",
       "signatures", "farthest", "least", "MiB read", "unused", "absent s", "blocked s", "first"}};
  const auto mib = [](ByteCount bytes) {
    return decimals_text(static_cast<double>(bytes) / static_cast<double>(kMiB), 2);
  };
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Choice& choice = choices[i];
    const Evaluated& result = results[i];
    const RunSummary& s = result.summary;
    const DriveAccount::Foreseen& foreseen = result.foreseen;
    const bool judged = choice.preload->foresees && foreseen.changes > 0;
    rows.push_back(
        {evaluation.maps[choice.map].name, evaluation.drives[choice.drive].files.name(),
         mib(s.budget_bytes), s.max_signatures == 0 ? "-" : std::to_string(s.max_signatures),
         std::string(choice.eviction->name), std::string(choice.preload->name),
         short_number(static_cast<double>(choice.storage_rate), 12), std::to_string(result.entered),
         std::to_string(s.zones_loaded), std::to_string(s.signatures_loaded),
         std::to_string(result.farthest.signatures), std::to_string(result.least.signatures),
         mib(result.bytes_read), mib(result.bytes_unused),
         s.localised ? decimals_text(s.zone_absent_s, 2) : "always", decimals_text(s.blocked_s, 2),
         judged
             ? decimals_text(
                   static_cast<double>(foreseen.first) / static_cast<double>(foreseen.changes), 3)
             : "-"});
  }
  return aligned(rows);
}

}  // namespace zonepack
