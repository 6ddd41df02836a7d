// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/localizer_figures.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"
#include "runtime/protocol/messages.hpp"
#include "runtime/serve/status_figures.hpp"

namespace zonepack {
namespace {

template <typename Fn>
void each_localizer(const wire::Status& status, Fn fn) {
  if (status.localizers() == nullptr) return;
  for (const wire::Localizer* const one : *status.localizers()) fn(*one);
}

template <typename Fn>
void each_reason(const wire::Localizer& localizer, Fn fn) {
  if (localizer.reasons() == nullptr) return;
  for (const wire::FixReason* const one : *localizer.reasons()) {
    fn(std::string(view_of(one->reason())), one->images());
  }
}

double share_of(const wire::Localizer& one) noexcept {
  return one.images_total() == 0
             ? 0
             : static_cast<double>(one.fixes_total()) / static_cast<double>(one.images_total());
}

std::string ms_text(std::int64_t ns) { return decimal_text(static_cast<double>(ns) / 1e6); }

std::string times_json(const wire::Timing* timing) {
  if (timing == nullptr || timing->count() == 0) return "null";
  return "{\"p50\":" + ms_text(timing->p50()) + ",\"p99\":" + ms_text(timing->p99()) +
         ",\"max\":" + ms_text(timing->max()) + "}";
}

std::string reasons_json(const wire::Localizer& one) {
  std::string text;
  each_reason(one, [&text](const std::string& reason, std::uint64_t images) {
    text += (text.empty() ? "" : ",") + json_quoted(reason) + ":" + std::to_string(images);
  });
  return "{" + text + "}";
}

struct LocalizerCounter {
  const char *name, *help;
  std::uint64_t (*value)(const wire::Localizer&);
};
constexpr LocalizerCounter kLocalizerCounters[] = {
    {"zoned_localizer_images_total", "Images that the localizer looked at.",
     [](const wire::Localizer& one) -> std::uint64_t { return one.images_total(); }},
    {"zoned_localizer_fixes_total", "Images with a pose that was given to zoned.",
     [](const wire::Localizer& one) -> std::uint64_t { return one.fixes_total(); }},
    {"zoned_localizer_skipped_total", "Images that came while the localizer was busy.",
     [](const wire::Localizer& one) -> std::uint64_t { return one.skipped_total(); }},
    {"zoned_localizer_refused_total", "Images of no use: size, damage, stamp.",
     [](const wire::Localizer& one) -> std::uint64_t { return one.refused_total(); }}};

std::string family_head(const std::string& name, const char* type, const char* help) {
  return "# HELP " + name + " " + help + "\n# TYPE " + name + " " + type + "\n";
}

std::string camera_label(const wire::Localizer& one) {
  return "camera=" + json_quoted(view_of(one.camera()));
}

using TimingOf = const wire::Timing* (wire::Localizer::*)() const;

std::string times_metric(const wire::Status& status, const char* name, const char* help,
                         TimingOf timing_of) {
  std::string text = family_head(name, "gauge", help);
  each_localizer(status, [&](const wire::Localizer& one) {
    const wire::Timing* const timing = (one.*timing_of)();
    if (timing == nullptr) return;
    const auto row = [&](const char* percentile, std::int64_t ns) {
      text += std::string(name) + "{" + camera_label(one) + ",percentile=\"" + percentile + "\"} " +
              decimal_text(static_cast<double>(ns) / 1e9) + "\n";
    };
    row("50", timing->p50());
    row("99", timing->p99());
    row("100", timing->max());
  });
  return text;
}

}  // namespace

std::vector<std::string> localizer_lines(const wire::Status& status) {
  std::vector<std::string> lines;
  each_localizer(status, [&lines](const wire::Localizer& one) {
    char share[32];
    std::snprintf(share, sizeof share, "%.1f %%", 100 * share_of(one));
    std::string line = "localizer " + std::string(view_of(one.camera())) + ": fixes of " + share +
                       " of " + counted(one.images_total(), "image");
    if (one.latency() != nullptr && one.latency()->count() > 0) {
      char times[64];
      std::snprintf(times, sizeof times, ", %.0f ms after the image, p99 %.0f ms",
                    static_cast<double>(one.latency()->p50()) / 1e6,
                    static_cast<double>(one.latency()->p99()) / 1e6);
      line += times;
    }
    std::string reasons;
    each_reason(one, [&reasons](const std::string& reason, std::uint64_t images) {
      reasons += (reasons.empty() ? "" : ", ") + reason + " " + std::to_string(images);
    });
    if (!reasons.empty()) line += "; without one: " + reasons;
    if (one.refused_total() > 0) line += "; " + counted(one.refused_total(), "image") + " refused";
    if (one.searching()) {
      line += "; the robot is lost: " + counted(one.search_views(), "view") + " compared with " +
              counted(one.search_zones(), "zone");
    }
    lines.push_back(std::move(line));
  });
  return lines;
}

std::string localizers_json(const wire::Status& status) {
  std::string text;
  each_localizer(status, [&text](const wire::Localizer& one) {
    text += (text.empty() ? "" : ",") + ("{\"camera\":" + json_quoted(view_of(one.camera()))) +
            ",\"images\":" + std::to_string(one.images_total()) +
            ",\"fixes\":" + std::to_string(one.fixes_total()) +
            ",\"share\":" + decimal_text(share_of(one)) +
            ",\"skipped\":" + std::to_string(one.skipped_total()) +
            ",\"refused\":" + std::to_string(one.refused_total()) +
            ",\"latency_ms\":" + times_json(one.latency()) +
            ",\"query_ms\":" + times_json(one.query()) + ",\"reasons\":" + reasons_json(one) +
            ",\"times_lost\":" + std::to_string(one.lost_total()) + ",\"searching\":" +
            (one.searching() ? "{\"views\":" + std::to_string(one.search_views()) +
                                   ",\"zones\":" + std::to_string(one.search_zones()) + "}"
                             : "null") +
            "}";
  });
  return "[" + text + "]";
}

std::string localizer_metrics(const wire::Status& status) {
  if (status.localizers() == nullptr || status.localizers()->size() == 0) return {};
  std::string text;
  for (const LocalizerCounter& counter : kLocalizerCounters) {
    text += family_head(counter.name, "counter", counter.help);
    each_localizer(status, [&](const wire::Localizer& one) {
      text += std::string(counter.name) + "{" + camera_label(one) + "} " +
              std::to_string(counter.value(one)) + "\n";
    });
  }
  const std::string none = "zoned_localizer_no_fix_total";
  text += family_head(none, "counter", "Images without a pose, by reason.");
  each_localizer(status, [&](const wire::Localizer& one) {
    each_reason(one, [&](const std::string& reason, std::uint64_t images) {
      text += none + "{" + camera_label(one) + ",reason=" + json_quoted(reason) + "} " +
              std::to_string(images) + "\n";
    });
  });
  text +=
      times_metric(status, "zoned_localizer_latency_seconds",
                   "From an image's stamp to its pose, by percentile.", &wire::Localizer::latency);
  return text + times_metric(status, "zoned_localizer_query_seconds",
                             "CPU time of an image, by percentile.", &wire::Localizer::query);
}

}  // namespace zonepack
