// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/log_match.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <set>

namespace zonepack {
namespace {

std::string id_text(std::uint32_t id, bool extended) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), extended ? "0x%08" PRIX32 : "0x%03" PRIX32, id);
  return std::string(text.data()) + (extended ? " (29 bits)" : " (11 bits)");
}

std::string times(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " time" : " times");
}

}  // namespace

std::optional<CanFrame> LogMatch::next() noexcept {
  std::optional<CanFrame> frame = frames_.next();
  if (!frame) return frame;
  first_ns_ = frames_seen_ == 0 ? frame->stamp_ns : std::min(first_ns_, frame->stamp_ns);
  last_ns_ = frames_seen_ == 0 ? frame->stamp_ns : std::max(last_ns_, frame->stamp_ns);
  ++frames_seen_;
  if (frame->error) return frame;
  const auto at = counts_.find({frame->id, frame->extended});
  if (at != counts_.end()) {
    ++at->second;
  } else if (counts_.size() < kMostIds) {
    counts_.emplace(Id{frame->id, frame->extended}, 1);
  } else {
    ++others_;
  }
  return frame;
}

std::string LogMatch::mismatch(const WheelOdometrySettings& settings, const std::string& path,
                               const CanLogSummary& summary, const std::string& holder) const {
  std::set<Id> wanted;
  for (const CanSignal& signal : signals_of(settings)) wanted.insert({signal.id, signal.extended});
  std::vector<Id> missing;
  for (const Id& id : wanted) {
    if (!counts_.contains(id)) missing.push_back(id);
  }
  if (missing.empty()) return {};
  std::string text = path + (missing.size() == wanted.size()
                                 ? ": holds none of the frames that odometry reads: expected "
                                 : ": lacks frames that odometry reads: expected ");
  for (const auto& [id, extended] : missing) {
    if (text.back() != ' ') text += ", ";
    text += id_text(id, extended);
  }
  for (const auto& [id, extended] : missing) {
    const auto twin = counts_.find({id, !extended});
    if (twin == counts_.end()) continue;
    text += "; " + id_text(id, !extended).substr(0, extended ? 5 : 10) + " came with " +
            (extended ? "an 11" : "a 29") + "-bit id " + times(twin->second) +
            (extended ? ": leave out extended: true"
                      : ": write extended: true (in a DBC file add 2147483648 to the id)");
  }
  std::vector<std::pair<Id, std::uint64_t>> found(counts_.begin(), counts_.end());
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t kListed = 8;
  text += "; the " + holder + (found.empty() ? " holds no data frame" : " has ");
  for (std::size_t i = 0; i < std::min(found.size(), kListed); ++i) {
    text += (i > 0 ? ", " : "") + id_text(found[i].first.first, found[i].first.second) + " " +
            times(found[i].second);
  }
  if (found.size() > kListed) {
    text += " and " + std::to_string(found.size() - kListed) + " further ids";
  }
  if (summary.other_interfaces > 0) {
    text += "; " + std::to_string(summary.other_interfaces) +
            " frames are of other interfaces than " + summary.interface + ": " +
            summary.other_names;
  }
  return text + "; check can.interface and the signals of the settings";
}

std::string range_text(std::int64_t first_ns, std::int64_t last_ns) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.3f to %.3f s", static_cast<double>(first_ns) / 1e9,
                static_cast<double>(last_ns) / 1e9);
  return text.data();
}

Outcome<void> check_overlap(const std::string& what, std::int64_t first_ns, std::int64_t last_ns,
                            const std::string& log, const LogMatch& match) {
  return check_overlap(what, first_ns, last_ns, log, match.first_ns(), match.last_ns());
}

Outcome<void> check_overlap(const std::string& what, std::int64_t first_ns, std::int64_t last_ns,
                            const std::string& log, std::int64_t log_first_ns,
                            std::int64_t log_last_ns) {
  if (first_ns <= log_last_ns && last_ns >= log_first_ns) return {};
  return failure(what + ": covers " + range_text(first_ns, last_ns) + ", and " + log + " " +
                 range_text(log_first_ns, log_last_ns) +
                 ": nothing of it could be used; expected stamps of the log's clock, in seconds");
}

}  // namespace zonepack
