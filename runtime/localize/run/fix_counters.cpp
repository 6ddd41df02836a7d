// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/fix_counters.hpp"

#include <cstdio>
#include <vector>

#include "platform/base/counted.hpp"
#include "platform/base/json_text.hpp"

namespace zonepack::localize {
namespace {

constexpr const char* kWithoutPose = "no_pose";
constexpr const char* kSearching = "searching";

wire::Timing wire_timing(const Histogram& histogram) {
  const TimingFigures f = histogram.figures();
  return {f.count, f.p50, f.p99, f.p999, f.p9999, f.max};
}

std::string decimal(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string in_ms(std::int64_t ns) { return decimal(static_cast<double>(ns) / 1e6); }

std::string percentiles_json(const Histogram& histogram) {
  return "\"p50\":" + in_ms(histogram.percentile(0.5)) +
         ",\"p95\":" + in_ms(histogram.percentile(0.95)) +
         ",\"p99\":" + in_ms(histogram.figures().p99) +
         ",\"max\":" + in_ms(histogram.figures().max);
}

}  // namespace

void FixCounters::count(const QueryResult& result, std::int64_t latency_ns) {
  ++images_;
  if (result.accepted) {
    ++accepted_;
    latency_.add(latency_ns < 0 ? 0 : latency_ns);
  } else {
    ++reasons_[static_cast<std::size_t>(result.reason)];
  }
  query_.add(result.cpu_total_ns);
  for (std::size_t i = 0; i < kStages; ++i) stages_[i].add(result.cpu_ns[i]);
}

flatbuffers::Offset<wire::Localizer> FixCounters::put(flatbuffers::FlatBufferBuilder& to,
                                                      const std::string& camera) const {
  std::vector<flatbuffers::Offset<wire::FixReason>> reasons;
  const auto add = [&](const char* reason, std::uint64_t images) {
    if (images == 0) return;
    reasons.push_back(wire::CreateFixReason(to, to.CreateString(reason), images));
  };
  for (std::size_t i = 0; i < kReasons; ++i) add(to_string(static_cast<Reason>(i)), reasons_[i]);
  add(kWithoutPose, without_pose_);
  add(kSearching, searching_);
  const auto list = to.CreateVector(reasons);
  const auto name = to.CreateString(camera.substr(0, 128));
  const wire::Timing latency = wire_timing(latency_), query = wire_timing(query_);
  return wire::CreateLocalizer(to, name, images_, fixes(), skipped_, refused_, &latency, &query,
                               list, lost_, search_.active, search_.views, search_.zones);
}

std::string FixCounters::json(std::uint64_t rss_peak_bytes, const std::string& calibration) const {
  std::string reasons;
  const auto add = [&](const char* reason, std::uint64_t images) {
    if (images == 0) return;
    reasons += (reasons.empty() ? "" : ",") + json_quoted(reason) + ":" + std::to_string(images);
  };
  for (std::size_t i = 0; i < kReasons; ++i) add(to_string(static_cast<Reason>(i)), reasons_[i]);
  add(kWithoutPose, without_pose_);
  add(kSearching, searching_);
  std::string stages;
  for (std::size_t i = 0; i < kStages; ++i) {
    stages += (i == 0 ? "" : ",") + json_quoted(to_string(static_cast<Stage>(i))) + ":{" +
              percentiles_json(stages_[i]) + "}";
  }
  const double share =
      images_ == 0 ? 0 : static_cast<double>(accepted_) / static_cast<double>(images_);
  return "{\"images\":" + std::to_string(images_) + ",\"accepted\":" + std::to_string(accepted_) +
         ",\"share\":" + decimal(share) + ",\"fixes_sent\":" + std::to_string(fixes()) +
         ",\"skipped\":" + std::to_string(skipped_) + ",\"refused\":" + std::to_string(refused_) +
         ",\"reasons\":{" + reasons + "},\"latency_ms\":{" + percentiles_json(latency_) +
         "},\"query_ms\":{" + percentiles_json(query_) + ",\"stages\":{" + stages +
         "}},\"rss_peak_bytes\":" + std::to_string(rss_peak_bytes) +
         ",\"calibration\":" + calibration + "}\n";
}

std::string FixCounters::text() const {
  std::string text = counted(accepted_, "fix", "fixes") + " of " + counted(images_, "image");
  std::string reasons;
  const auto add = [&](const char* reason, std::uint64_t images) {
    if (images == 0) return;
    reasons += (reasons.empty() ? "" : ", ") + std::string(reason) + " " + std::to_string(images);
  };
  for (std::size_t i = 0; i < kReasons; ++i) add(to_string(static_cast<Reason>(i)), reasons_[i]);
  add(kWithoutPose, without_pose_);
  add(kSearching, searching_);
  if (!reasons.empty()) text += "; without one: " + reasons;
  if (lost_ > 0) text += "; lost " + counted(lost_, "time");
  if (not_taken_ > 0) text += "; " + counted(not_taken_, "fix", "fixes") + " not taken by zoned";
  if (refused_ > 0) text += "; " + counted(refused_, "image") + " refused";
  if (skipped_ > 0) text += "; " + counted(skipped_, "image") + " skipped";
  return text;
}

}  // namespace zonepack::localize
