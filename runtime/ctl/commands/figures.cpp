// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "platform/base/byte_count.hpp"
#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"
#include "runtime/ctl/commands/localizer_figures.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/serve/status_figures.hpp"

namespace zonepack {
namespace {

using Kind = StatusFigure::Kind;

struct Percentile {
  const char* key;
  const char* label;
  std::int64_t ns;
};
std::vector<Percentile> percentiles(const wire::Timing* timing) {
  if (timing == nullptr) return {};
  return {{"p50", "50", timing->p50()},
          {"p99", "99", timing->p99()},
          {"p999", "99.9", timing->p999()},
          {"p9999", "99.99", timing->p9999()},
          {"max", "100", timing->max()}};
}

std::string timing_metric(const char* name, const char* help, const wire::Timing* timing) {
  std::string text = std::string("# HELP ") + name + " " + help + "\n# TYPE " + name + " gauge\n";
  for (const Percentile& p : percentiles(timing)) {
    text += std::string(name) + "{percentile=\"" + p.label + "\"} " +
            decimal_text(static_cast<double>(p.ns) / 1e9) + "\n";
  }
  return text;
}

std::string timing_json(const wire::Timing* timing) {
  std::string text = "{";
  for (const Percentile& p : percentiles(timing)) {
    text += std::string(text.size() > 1 ? "," : "") + "\"" + p.key +
            "\":" + decimal_text(static_cast<double>(p.ns) / 1e3);
  }
  return text + "}";
}

template <typename Fn>
void each_line(const wire::Status& status, Fn fn) {
  if (status.lines() == nullptr) return;
  for (const wire::Line* const line : *status.lines())
    fn(*line, std::string(view_of(line->name())));
}

struct LineMetric {
  const char *name, *type, *help;
  std::uint64_t (*value)(const wire::Line&);
};
constexpr LineMetric kLineMetrics[] = {
    {"zoned_line_active", "gauge", "The line is active.",
     [](const wire::Line& line) -> std::uint64_t { return line.active(); }},
    {"zoned_line_working", "gauge", "The line is open, and its last call went well.",
     [](const wire::Line& line) -> std::uint64_t { return line.working(); }},
    {"zoned_line_changes_total", "counter", "Times that the line changed.",
     [](const wire::Line& line) -> std::uint64_t { return line.changes(); }},
    {"zoned_line_failures_total", "counter", "Calls to the line that failed.",
     [](const wire::Line& line) -> std::uint64_t { return line.failures(); }}};

std::string line_metrics(const wire::Status& status) {
  if (status.lines() == nullptr || status.lines()->size() == 0) return {};
  std::string text;
  for (const LineMetric& metric : kLineMetrics) {
    const std::string name = metric.name;
    text += "# HELP " + name + " " + metric.help + "\n# TYPE " + name + " " + metric.type + "\n";
    each_line(status, [&](const wire::Line& line, const std::string& line_name) {
      text += name + "{line=" + json_quoted(line_name) + "} " + std::to_string(metric.value(line)) +
              "\n";
    });
  }
  return text + timing_metric("zoned_map_ready_latency_seconds",
                              "From the end of a load to map_ready's line, by percentile.",
                              status.map_ready_latency());
}

std::string lines_json(const wire::Status& status) {
  std::string text = "{";
  each_line(status, [&](const wire::Line& line, const std::string& name) {
    text += (text.size() > 1 ? "," : "") + json_quoted(name) +
            ":{\"active\":" + (line.active() ? "true" : "false") +
            ",\"working\":" + (line.working() ? "true" : "false") +
            ",\"changes\":" + std::to_string(line.changes()) +
            ",\"failures\":" + std::to_string(line.failures()) + "}";
  });
  return text + "}";
}

// JSON has no numbers that are not finite.
std::string json_real(double value) { return std::isfinite(value) ? decimal_text(value) : "null"; }

std::string pose_json(const wire::PoseReport* pose) {
  if (pose == nullptr || !pose->valid() || pose->pose() == nullptr) return "null";
  return "{\"x_m\":" + json_real(pose->pose()->x()) + ",\"y_m\":" + json_real(pose->pose()->y()) +
         ",\"yaw_rad\":" + json_real(pose->pose()->yaw()) +
         ",\"sigma_m\":" + json_real(sigma_m_of(pose)) +
         ",\"trusted\":" + (pose->trusted() ? "true" : "false") + "}";
}

}  // namespace

std::string metrics_text(const wire::Status& status) {
  std::string text;
  for (const StatusFigure& figure : status_figures()) {
    const std::string name = figure.metric;
    text += "# HELP " + name + " " + figure.help + "\n# TYPE " + name +
            (figure.kind == Kind::kCounter ? " counter\n" : " gauge\n") + name + " " +
            figure.text(status) + "\n";
  }
  text +=
      timing_metric("zoned_cycle_seconds", "A cycle's own work, by percentile.", status.cycle());
  text += timing_metric("zoned_wakeup_seconds", "How late cycles begin, by percentile.",
                        status.wakeup());
  text += line_metrics(status);
  text += localizer_metrics(status);
  const std::string zone(view_of(status.zone()));
  text += "# HELP zoned_zone_info The robot's own zone.\n# TYPE zoned_zone_info gauge\n";
  if (!zone.empty()) text += "zoned_zone_info{zone=" + json_quoted(zone) + "} 1\n";
  return text;
}

std::string map_version(const wire::Status& status) {
  if (status.map_version() == nullptr) return {};
  return to_hex({status.map_version()->data(), status.map_version()->size()});
}

std::string status_json(const wire::Status& status) {
  std::string text = "{\"zone\":";
  const std::string zone(view_of(status.zone()));
  text += zone.empty() ? "null" : json_quoted(zone);
  text += ",\"map_version\":\"" + map_version(status) + "\"";
  text += ",\"pose\":" + pose_json(status.pose());
  for (const StatusFigure& figure : status_figures()) {
    const std::string value = figure.text(status);
    const bool is_flag = figure.kind == Kind::kFlag;
    text += std::string(",\"") + figure.key +
            "\":" + (is_flag ? (value == "1" ? "true" : "false") : value);
  }
  text += ",\"cycle_us\":" + timing_json(status.cycle());
  text += ",\"wakeup_us\":" + timing_json(status.wakeup());
  text += ",\"map_ready_latency_us\":" + timing_json(status.map_ready_latency());
  text += ",\"lines\":" + lines_json(status);
  text += ",\"localizers\":" + localizers_json(status);
  return text + "}\n";
}

std::vector<std::string> figure_lines(const wire::Status& status) {
  std::vector<std::string> lines;
  for (const StatusFigure& figure : status_figures()) {
    std::string value = figure.text(status);
    if (figure.kind == Kind::kFlag) value = value == "1" ? "yes" : "no";
    std::string line = figure.key;
    line.resize(std::max<std::size_t>(line.size(), 22), ' ');
    line += " " + value;
    if (std::string_view(figure.key).ends_with("_bytes")) {
      line += "  (" + short_bytes(std::strtoull(value.c_str(), nullptr, 10)) + ")";
    }
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> line_words(const wire::Status& status) {
  std::vector<std::string> words;
  each_line(status, [&words](const wire::Line& line, const std::string& name) {
    words.push_back(name + (line.active() ? " active" : " inactive") +
                    (line.working() ? "" : ", not working") + ", " +
                    counted(line.changes(), "change"));
  });
  return words;
}

std::vector<std::string> complaints(const wire::Status& s) {
  std::vector<std::string> lines;
  const std::string zone(view_of(s.zone()));
  if (!zone.empty() && !s.zone_resident()) {
    lines.push_back("NOT KEEPING UP: the robot is in " + zone +
                    ", which is not in memory; raise memory.budget or preload.margin");
  }
  if (s.blocked()) {
    lines.push_back("BLOCKED: a wanted zone does not fit next to what must stay" +
                    std::string(s.frozen() ? "; zonectl unfreeze" : "; raise memory.budget"));
  }
  if (!s.can_up()) {
    lines.push_back("NO CAN BUS: no odometry, the pose gets less sure; ip -details link show");
  }
  if (s.pose() == nullptr || !s.pose()->valid()) {
    lines.push_back("NO POSE: waiting for a fix, or for zonectl pose X Y YAW_DEG");
  } else if (!s.pose()->trusted()) {
    lines.push_back("POSE NOT TRUSTED: until two fixes agree");
  }
  each_line(s, [&lines](const wire::Line& line, const std::string& name) {
    if (!line.working()) {
      lines.push_back("LINE NOT WORKING: " + name + "; see zoned run --check and its log");
    }
  });
  if (!s.realtime()) lines.push_back("NOT REAL-TIME: see zoned run --check");
  if (!s.memory_locked()) lines.push_back("MEMORY NOT LOCKED: see zoned run --check");
  return lines;
}

}  // namespace zonepack
