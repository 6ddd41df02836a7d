// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/evaluate_report.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "runtime/evaluate/evaluate_totals.hpp"
#include "runtime/report/chart.hpp"
#include "runtime/report/format.hpp"

namespace zonepack {
namespace {

using report::Chart;
using report::ChartSeries;
using report::Figure;
using report::format_count;
using report::format_fixed;
using report::Report;
using report::Sample;

constexpr std::size_t kMostCurves = 9;  // in one chart
constexpr std::size_t kMostRows = 400;  // of the table

std::string bytes_text(ByteCount bytes) { return report::format_bytes(static_cast<double>(bytes)); }

Figure figure_of(std::string title, std::string caption, const Chart& chart, bool over_time) {
  return {std::move(title), std::move(caption), report::draw_chart(chart),
          report::draw_chart(report::narrowed(chart)),
          over_time ? report::chart_json(chart) : std::string()};
}

std::string runs_text(std::size_t count, const char* one) {
  return format_count(count) + " " + one + (count == 1 ? "" : "s");
}

// ---- Over the budget.

// The choices that are drawn in one chart.
bool same_chart(const Choice& a, const Choice& b, bool over_budget) {
  return a.map == b.map && a.preload == b.preload && a.storage_rate == b.storage_rate &&
         (over_budget ? a.max_signatures == b.max_signatures : a.budget == b.budget);
}

std::string terms_text(const Evaluation& evaluation, const Totals& of, bool over_budget) {
  std::string text = short_name(evaluation.maps[of.choice.map].name) + ", preload " +
                     std::string(of.choice.preload->name) + ", " +
                     bytes_text(of.choice.storage_rate) + "/s";
  if (over_budget && of.choice.max_signatures > 0) {
    text += ", at most " + format_count(of.choice.max_signatures) + " signatures";
  }
  if (!over_budget) text += ", budget " + bytes_text(of.budget_bytes);
  return text;
}

void sort_samples(std::vector<Sample>& samples) { std::ranges::sort(samples, {}, &Sample::t_s); }

Chart limit_chart(const std::vector<const Totals*>& all, bool over_budget) {
  Chart chart;
  chart.plot_height_px = 280;
  chart.axis = over_budget ? "budget" : "most signatures in memory";
  if (over_budget) chart.axis_quantity = report::Quantity::kBytes;
  const auto at = [&](const Totals& totals) {
    return static_cast<double>(over_budget ? totals.budget_bytes : totals.choice.max_signatures);
  };
  ChartSeries farthest{.name = "evicting what is used farthest ahead",
                       .samples = {},
                       .color = report::kOther,
                       .steps = false,
                       .compared = true};
  ChartSeries least{.name = "no choice loads less",
                    .samples = {},
                    .color = report::kOtherToo,
                    .steps = false,
                    .compared = true};
  for (const Totals* const totals : all) {
    const std::string name(totals->choice.eviction->name);
    auto series = std::ranges::find(chart.series, name, &ChartSeries::name);
    if (series == chart.series.end()) {
      chart.series.push_back(
          {.name = name, .samples = {}, .color = report::hue(chart.series.size()), .steps = false});
      series = std::prev(chart.series.end());
    }
    series->samples.push_back({at(*totals), static_cast<double>(totals->signatures)});
    if (totals->choice.eviction != all.front()->choice.eviction) continue;
    farthest.samples.push_back({at(*totals), static_cast<double>(totals->farthest.signatures)});
    least.samples.push_back({at(*totals), static_cast<double>(totals->least.signatures)});
  }
  chart.series.push_back(std::move(farthest));
  chart.series.push_back(std::move(least));
  for (ChartSeries& series : chart.series) sort_samples(series.samples);
  return chart;
}

void add_limit_figures(const Evaluation& evaluation, const std::vector<Totals>& totals,
                       Report& page) {
  std::set<ByteCount> budgets;
  std::set<std::uint64_t> limits;
  for (const Totals& one : totals) {
    budgets.insert(one.budget_bytes);
    limits.insert(one.choice.max_signatures);
  }
  const bool over_budget = budgets.size() > 1 || limits.size() < 2;
  std::vector<bool> drawn(totals.size(), false);
  for (std::size_t i = 0; i < totals.size(); ++i) {
    if (drawn[i]) continue;
    std::vector<const Totals*> together;
    std::set<double> places;
    for (std::size_t k = i; k < totals.size(); ++k) {
      if (!same_chart(totals[i].choice, totals[k].choice, over_budget)) continue;
      drawn[k] = true;
      together.push_back(&totals[k]);
      places.insert(static_cast<double>(over_budget ? totals[k].budget_bytes
                                                    : totals[k].choice.max_signatures));
    }
    if (places.size() < 2) continue;
    page.figures.push_back(figure_of(
        std::string("Signatures loaded over the ") + (over_budget ? "budget" : "limit") + ": " +
            terms_text(evaluation, totals[i], over_budget),
        "All " + runs_text(evaluation.drives.size(), "drive") +
            " together. Grey: evicting, with the future known, what is used farthest ahead; and "
            "what provably no choice of whom to evict could go below, both for the requests of " +
            std::string(totals[i].choice.eviction->name) + ".",
        limit_chart(together, over_budget), false));
  }
}

// ---- Over time.

template <typename Value>
std::vector<Sample> curve(const RunTrace& trace, Value&& value) {
  std::vector<Sample> samples;
  for (const TraceSample& sample : trace.samples) {
    const auto now = static_cast<double>(value(sample));
    if (samples.empty() || samples.back().value != now) samples.push_back({sample.t_s, now});
  }
  if (!samples.empty()) samples.push_back({trace.duration_s, samples.back().value});
  return samples;
}

std::vector<Sample> curve(const std::vector<BaselineRow>& rows, double BaselineRow::*value) {
  std::vector<Sample> samples;
  samples.reserve(rows.size());
  for (const BaselineRow& row : rows) samples.push_back({row.t_s, row.*value});
  return samples;
}

struct TimeCurve {
  const char* title;
  const char* caption;
  std::uint64_t TraceSample::*ours;
  double BaselineRow::*theirs;
};
constexpr TimeCurve kCurves[] = {
    {"Signatures retrieved", "Loaded since the start. The fewer the better.",
     &TraceSample::signatures_loaded, &BaselineRow::loaded},
    {"Signatures removed", "Unloaded since the start.", &TraceSample::signatures_unloaded,
     &BaselineRow::unloaded},
    {"Signatures in working memory", "Resident, or being loaded.", &TraceSample::charged_signatures,
     &BaselineRow::in_memory}};

void add_time_figures(const Evaluation& evaluation, const std::vector<Choice>& choices,
                      const std::vector<Evaluated>& results, Report& page) {
  for (std::size_t drive = 0; drive < evaluation.drives.size(); ++drive) {
    std::vector<std::size_t> runs;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (choices[i].curves && choices[i].drive == drive) runs.push_back(i);
    }
    // Too many lines to follow: of each map only the first policy.
    if (runs.size() > kMostCurves) {
      const NamedEviction* const first = choices[runs.front()].eviction;
      std::erase_if(runs, [&](std::size_t i) { return choices[i].eviction != first; });
    }
    if (runs.size() > kMostCurves) runs.resize(kMostCurves);
    const Drive& of = evaluation.drives[drive];
    for (const TimeCurve& what : kCurves) {
      Chart chart;
      chart.plot_height_px = 170;
      for (const std::size_t i : runs) {
        const RunTrace& trace = results[i].trace;
        chart.duration_s = std::max(chart.duration_s, trace.duration_s);
        std::string name = short_name(evaluation.maps[choices[i].map].name) + " " +
                           std::string(choices[i].eviction->name) + ", " +
                           bytes_text(results[i].summary.budget_bytes);
        chart.series.push_back(
            {.name = std::move(name),
             .samples = curve(trace, [&](const TraceSample& s) { return s.*what.ours; }),
             .color = report::hue(chart.series.size())});
      }
      if (!of.baseline.empty()) {
        chart.series.push_back({.name = "RTAB-Map",
                                .samples = curve(of.baseline, what.theirs),
                                .color = report::kOther,
                                .compared = true});
      }
      page.figures.push_back(figure_of(std::string(what.title) + ": " + short_name(of.files.name()),
                                       what.caption, chart, true));
    }
  }
}

// ---- In numbers.

std::string percent(double part, double whole) {
  return whole > 0 ? format_fixed(100 * part / whole, 1) + " %" : "-";
}

// Of the first columns, which name the choice, those with one value only become words.
void move_constants_to_caption(report::Table& table, std::size_t columns) {
  std::string everywhere;
  for (std::size_t c = columns; c-- > 1;) {
    const auto cell = static_cast<std::ptrdiff_t>(c);
    const std::string value = table.rows.front()[c];
    if (std::ranges::any_of(table.rows, [&](const auto& row) { return row[c] != value; })) continue;
    if (value != "-") {
      std::string name = table.columns[c].name;
      name[0] = static_cast<char>(name[0] - 'A' + 'a');
      everywhere = name + " " + value + (everywhere.empty() ? "" : ", ") + everywhere;
    }
    table.columns.erase(table.columns.begin() + cell);
    for (auto& row : table.rows) row.erase(row.begin() + cell);
  }
  if (!everywhere.empty()) table.caption += " Everywhere: " + everywhere + ".";
}

void add_totals_table(const Evaluation& evaluation, const std::vector<Totals>& totals,
                      Report& page) {
  report::Table table{
      "Totals",
      "All drives together. Farthest: evicting what is used farthest ahead; least: no choice of "
      "whom to evict loads less. Unused: of the bytes read. First: how often the zone entered next "
      "was the first that was loaded or kept ahead.",
      {{"Map"},
       {"Budget", true},
       {"Most", true},
       {"Eviction"},
       {"Preload"},
       {"Read/s", true},
       {"Zones", true},
       {"Signatures", true},
       {"Farthest", true},
       {"Least", true},
       {"Read", true},
       {"Unused", true},
       {"Absent s", true},
       {"Waited s", true},
       {"First", true}},
      {}};
  for (const Totals& t : totals) {
    if (table.rows.size() == kMostRows) break;
    const Choice& choice = t.choice;
    table.rows.push_back(
        {short_name(evaluation.maps[choice.map].name), bytes_text(t.budget_bytes),
         choice.max_signatures == 0 ? "-" : format_count(choice.max_signatures),
         std::string(choice.eviction->name), std::string(choice.preload->name),
         bytes_text(choice.storage_rate), format_count(t.loads), format_count(t.signatures),
         format_count(t.farthest.signatures), format_count(t.least.signatures),
         bytes_text(t.bytes_read),
         percent(static_cast<double>(t.bytes_unused), static_cast<double>(t.bytes_read)),
         t.never_localised == t.runs ? "-" : format_fixed(t.absent_s, 2),
         format_fixed(t.blocked_s, 2),
         choice.preload->foresees ? percent(static_cast<double>(t.foreseen.first),
                                            static_cast<double>(t.foreseen.changes))
                                  : "-"});
  }
  move_constants_to_caption(table, 6);
  if (totals.size() > kMostRows) {
    table.caption += " The first " + format_count(kMostRows) + " of " +
                     format_count(totals.size()) + " rows; --json has all.";
  }
  page.tables.push_back(std::move(table));
}

std::string headline(const std::vector<Totals>& totals) {
  const Totals& best = *std::ranges::min_element(totals, {}, &Totals::signatures);
  return "Of " + runs_text(totals.size(), "combination") + ", " +
         std::string(best.choice.eviction->name) + " in " + bytes_text(best.budget_bytes) +
         " loads least: " + format_count(best.signatures) +
         " signatures. Evicting what is used farthest ahead would load " +
         format_count(best.farthest.signatures) + " there, and no choice fewer than " +
         format_count(best.least.signatures) + ".";
}

}  // namespace

Report make_evaluation_report(const Evaluation& evaluation, const std::vector<Choice>& choices,
                              const std::vector<Evaluated>& results) {
  const std::vector<Totals> totals = totals_of(choices, results);
  Report page;
  page.title = "Evaluation of " + runs_text(evaluation.drives.size(), "drive") + " on " +
               runs_text(evaluation.maps.size(), "map");
  page.headline = headline(totals);
  add_limit_figures(evaluation, totals, page);
  add_time_figures(evaluation, choices, results, page);
  add_totals_table(evaluation, totals, page);
  std::string maps, drives;
  for (const EvaluatedMap& map : evaluation.maps) maps += (maps.empty() ? "" : ", ") + map.name;
  for (const Drive& drive : evaluation.drives) {
    drives += (drives.empty() ? "" : ", ") + drive.files.name();
  }
  page.origin = "Maps: " + maps + ". Drives: " + drives + ". " + runs_text(choices.size(), "run") +
                ", loads modelled.";
  return page;
}

}  // namespace zonepack
