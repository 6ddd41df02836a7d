// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/loop_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/odometry/poses_apart.hpp"
#include "runtime/report/format.hpp"
#include "runtime/run/figures/run_figures.hpp"

namespace zonepack::localize {
namespace {

using report::Color;
using report::format_count;
using report::format_fixed;
using report::PlanDot;
using report::PlanDots;

// Reasons, the most frequent first; they differ for colour-blind readers, on light and on dark.
constexpr std::array<Color, 6> kReasonColors = {{{0xe0, 0x7b, 0x00},
                                                 {0xcc, 0x66, 0x77},
                                                 {0x2b, 0xa0, 0xb8},
                                                 {0x99, 0x99, 0x33},
                                                 {0x3b, 0xa7, 0x8f},
                                                 {0xc8, 0x9b, 0x2c}}};

double seconds(std::int64_t t_ns, const CameraLoop& loop) {
  return static_cast<double>(t_ns - loop.start_ns()) * 1e-9;
}

// "few_inliers" for people.
std::string in_words(std::string reason) {
  std::ranges::replace(reason, '_', ' ');
  return reason;
}

// Where the robot believed to be.
std::optional<Pose2> believed_at(const RunTrace& trace, double t_s) {
  const auto after = std::ranges::upper_bound(trace.samples, t_s, {}, &TraceSample::t_s);
  if (after == trace.samples.begin()) return std::nullopt;
  const TraceSample& sample = *std::prev(after);
  return sample.pose_valid ? std::optional(sample.estimate) : std::nullopt;
}

// Fixes judged by the truth.
struct Judged {
  std::size_t fixes = 0, right = 0, wrong = 0;
  std::vector<double> errors_m;

  // Whether this fix is wrong.
  bool take(const Pose2& fix, const std::optional<Pose2>& truth) {
    ++fixes;
    if (!truth) return false;
    errors_m.push_back(apart_m(fix, *truth));
    const bool good = is_right(fix, *truth);
    ++(good ? right : wrong);
    return !good;
  }
};

std::string error_text(const Pose2& fix, const std::optional<Pose2>& truth) {
  if (!truth) return {};
  return ", " + format_fixed(100 * apart_m(fix, *truth), 1) + " cm off the truth";
}

struct Fixes {
  Judged ours, beside;
  std::vector<PlanDots> layers;  // in the order of drawing
};

class FixPlan {
 public:
  explicit FixPlan(const LoopReportInput& input) : input_(input) {}

  Fixes collect() {
    add_beside();
    add_ours();
    for (PlanDots* layer : {&beside_, &beside_wrong_, &accepted_}) {
      if (!layer->dots.empty()) out_.layers.push_back(std::move(*layer));
    }
    add_reasons();
    if (!wrong_.dots.empty()) out_.layers.push_back(std::move(wrong_));
    return std::move(out_);
  }

 private:
  std::optional<Pose2> truth_at(std::int64_t t_ns) const {
    return input_.truth != nullptr ? input_.truth->at(t_ns) : std::nullopt;
  }

  void add_beside() {
    if (input_.beside == nullptr) return;
    const std::string& name = input_.beside->name;
    beside_ = {.name = name, .color = report::kOther, .ring = true, .dots = {}};
    beside_wrong_ = {.name = name + ", wrong", .color = report::kLimit, .ring = true, .dots = {}};
    for (const BesideRun::Fix& fix : input_.beside->fixes) {
      if (fix.stamp_ns < input_.loop.start_ns() || fix.stamp_ns > input_.loop.end_ns()) continue;
      const auto truth = truth_at(fix.stamp_ns);
      const bool wrong = out_.beside.take(fix.T_map_base, truth);
      const double t_s = seconds(fix.stamp_ns, input_.loop);
      (wrong ? beside_wrong_ : beside_)
          .dots.push_back(
              {{fix.T_map_base.x_m, fix.T_map_base.y_m},
               t_s,
               name + ", " + format_fixed(t_s, 1) + " s" + error_text(fix.T_map_base, truth)});
    }
  }

  void add_ours() {
    accepted_ = {.name = "fix", .color = report::kOurs, .ring = false, .dots = {}};
    wrong_ = {.name = "wrong fix", .color = report::kLimit, .ring = false, .dots = {}};
    for (const LoopView& view : input_.loop.views()) {
      const double t_s = seconds(view.image.stamp_ns, input_.loop);
      const std::string where = format_fixed(t_s, 1) + " s, " +
                                std::filesystem::path(view.image.file).filename().string() + ": ";
      if (view.result.accepted) {
        const Pose2& pose = view.fix.T_map_base;
        const auto truth = truth_at(view.fix.stamp_ns);
        const bool wrong = out_.ours.take(pose, truth);
        (wrong ? wrong_ : accepted_)
            .dots.push_back({{pose.x_m, pose.y_m},
                             t_s,
                             where + std::to_string(view.result.distinct) + " inliers" +
                                 error_text(pose, truth)});
        continue;
      }
      const std::string reason = in_words(reason_of(view));
      auto layer = std::ranges::find(reasons_, reason, &PlanDots::name);
      if (layer == reasons_.end()) {
        layer = reasons_.insert(reasons_.end(), {.name = reason, .color = {}, .dots = {}});
      }
      auto pose = believed_at(input_.run.trace, t_s);
      if (!pose) pose = truth_at(view.image.stamp_ns);
      const Point2 place = pose ? Point2{pose->x_m, pose->y_m} : Point2{std::nan(""), std::nan("")};
      layer->dots.push_back({place, t_s, where + reason});
    }
  }

  void add_reasons() {
    std::ranges::stable_sort(reasons_, std::ranges::greater(),
                             [](const PlanDots& layer) { return layer.dots.size(); });
    for (std::size_t i = 0; i < reasons_.size(); ++i) {
      reasons_[i].color = i < kReasonColors.size() ? kReasonColors[i] : report::kWall;
      out_.layers.push_back(std::move(reasons_[i]));
    }
  }

  const LoopReportInput& input_;
  Fixes out_;
  PlanDots beside_, beside_wrong_, accepted_, wrong_;
  std::vector<PlanDots> reasons_;
};

// Pale zones and a thin route, so that the dots stand out.
report::FloorPlan plan_of(const LoopReportInput& input, std::vector<PlanDots> layers) {
  const RunTrace& trace = input.run.trace;
  report::FloorPlan plan = route_plan(trace, std::vector<Color>(trace.zones.size(), report::kWall));
  if (plan.true_route.empty()) {
    for (const report::PlanRoutePoint& point : plan.route) plan.true_route.push_back(point.p_map);
    plan.true_route_name = "believed route";
  }
  plan.route.clear();
  plan.portals.clear();
  plan.dots = std::move(layers);
  return plan;
}

std::string share_text(std::size_t part, std::size_t whole) {
  if (whole == 0) return "–";
  return format_fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::vector<std::string> row_of(const std::string& name, std::size_t images, const Judged& judged,
                                bool has_truth) {
  const auto errors = spread_of(judged.errors_m);
  const auto centimetres = [&](double Spread::*which) {
    return errors ? format_fixed(100 * (*errors).*which, 1) : std::string("–");
  };
  const auto counted = [&](std::size_t count) {
    return has_truth ? format_count(count) : std::string("–");
  };
  return {name,
          images > 0 ? format_count(images) : std::string("–"),
          format_count(judged.fixes),
          share_text(judged.fixes, images),
          counted(judged.right),
          counted(judged.wrong),
          centimetres(&Spread::p50),
          centimetres(&Spread::p95),
          centimetres(&Spread::max)};
}

report::Table fix_table(const LoopReportInput& input, const Fixes& fixes) {
  report::Table table{"Fixes",
                      "Right: within half a metre and ten degrees of the truth. Errors in "
                      "centimetres: half of the fixes and 95 % of them are not above; the largest.",
                      {{"Localizer"},
                       {"Images", true},
                       {"Fixes", true},
                       {"Share", true},
                       {"Right", true},
                       {"Wrong", true},
                       {"p50, cm", true},
                       {"p95, cm", true},
                       {"Most, cm", true}},
                      {}};
  const bool has_truth = input.truth != nullptr;
  table.rows.push_back(row_of("zoneloc", input.figures.images, fixes.ours, has_truth));
  if (input.beside != nullptr) {
    table.rows.push_back(row_of(input.beside->name, input.beside->images, fixes.beside, has_truth));
  }
  return table;
}

report::Table reason_table(const Fixes& fixes, std::size_t images) {
  report::Table table{"Images without a fix",
                      "zoneloc query --draw shows one such image with what was matched, and says "
                      "why there is no pose.",
                      {{"Reason"}, {"Images", true}, {"Share", true}, {"First at, s", true}},
                      {}};
  for (const PlanDots& layer : fixes.layers) {
    if (layer.ring || layer.color == report::kOurs || layer.color == report::kLimit) continue;
    table.rows.push_back({layer.name, format_count(layer.dots.size()),
                          share_text(layer.dots.size(), images),
                          format_fixed(layer.dots.front().t_s, 1)});
  }
  return table;
}

std::string headline(const LoopReportInput& input, const Fixes& fixes) {
  const LoopFigures& figures = input.figures;
  std::string text = "A fix from " + format_count(figures.accepted) + " of " +
                     format_count(figures.images) + " images (" +
                     share_text(figures.accepted, figures.images) + ")";
  if (figures.wrong) {
    text += *figures.wrong == 0 ? ", none of them wrong"
                                : ", of which " + format_count(*figures.wrong) +
                                      (*figures.wrong == 1 ? " is wrong" : " are wrong");
  }
  if (input.beside == nullptr) return text + ".";
  text += "; " + input.beside->name + " found " + format_count(fixes.beside.fixes);
  if (input.beside->images > 0) {
    text += " (" + share_text(fixes.beside.fixes, input.beside->images) + ")";
  }
  if (input.truth != nullptr && fixes.beside.wrong > 0) {
    text += ", " + format_count(fixes.beside.wrong) + " wrong";
  }
  return text + ".";
}

void add_facts(const LoopFigures& figures, std::vector<report::Fact>& facts) {
  facts.insert(facts.begin(),
               {"fixes", format_count(figures.accepted) + " of " + format_count(figures.images),
                figures.wrong ? format_count(*figures.wrong) + " wrong"
                              : std::string("no truth, so nothing is known of wrong ones"),
                figures.wrong.value_or(0) > 0});
  facts.insert(facts.begin() + 1,
               {"longest time without a fix", report::format_seconds(figures.longest_gap_s), {}});
  if (figures.query_ms) {
    facts.insert(facts.begin() + 2,
                 {"an image takes, median", format_fixed(figures.query_ms->p50, 1) + " ms",
                  "95 %: " + format_fixed(figures.query_ms->p95, 1) + " ms of processor time"});
  }
}

std::string caption(const LoopReportInput& input) {
  std::string text =
      "A dot is an image: where the camera put the robot, or, in other colours, where the robot "
      "believed to be when there was no fix, by reason.";
  if (input.beside != nullptr) {
    text += " Rings are the fixes of " + input.beside->name + " on the same drive.";
  }
  return text;
}

}  // namespace

report::Report make_loop_report(const LoopReportInput& input) {
  Fixes fixes = FixPlan(input).collect();
  report::Report page = make_run_report(input.run);
  page.title = "Closed loop of " + input.run.recording;
  page.headline = headline(input, fixes) + " " + page.headline;
  add_facts(input.figures, page.facts);
  std::vector<report::Table> tables{fix_table(input, fixes)};
  if (report::Table reasons = reason_table(fixes, input.figures.images); !reasons.rows.empty()) {
    tables.push_back(std::move(reasons));
  }
  page.tables.insert(page.tables.begin(), std::make_move_iterator(tables.begin()),
                     std::make_move_iterator(tables.end()));
  const report::FloorPlan plan = plan_of(input, std::move(fixes.layers));
  page.figures.insert(page.figures.begin() + 1,
                      {"The fixes, from above", caption(input), report::draw_floor_plan(plan),
                       report::draw_floor_plan(report::narrowed(plan)), report::dots_json()});
  return page;
}

report::Report make_loop_picture(const LoopReportInput& input) {
  Fixes fixes = FixPlan(input).collect();
  report::Report page;
  page.headline = headline(input, fixes);
  page.figures.push_back(
      {"", "", report::draw_floor_plan(plan_of(input, std::move(fixes.layers)))});
  return page;
}

}  // namespace zonepack::localize
