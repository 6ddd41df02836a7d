// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "runtime/localize/query/query_result.hpp"
#include "runtime/protocol/protocol_generated.h"
#include "runtime/run/figures/histogram.hpp"

namespace zonepack::localize {

// What zoneloc counts about itself, for zoned's status and its own summary.
class FixCounters {
 public:
  // An image that was looked at. latency_ns: from its stamp to now.
  void count(const QueryResult& result, std::int64_t latency_ns);
  // An image that came while zoned had no pose that says where to look.
  void count_without_pose() noexcept { ++images_, ++without_pose_; }
  // A fix that zoned did not take.
  void count_not_taken() noexcept { ++not_taken_; }
  void count_skipped(std::uint64_t images) noexcept { skipped_ += images; }
  void count_refused() noexcept { ++refused_; }
  // An image that became a view of a search.
  void count_searching() noexcept { ++images_, ++searching_; }
  // A fix of such an image, once the robot was found.
  void count_found() noexcept { ++accepted_, --searching_; }
  void count_lost() noexcept { ++lost_; }
  struct Search {
    bool active = false;
    std::uint32_t views = 0, zones = 0;
  };
  void set_search(const Search& search) noexcept { search_ = search; }

  std::uint64_t images() const noexcept { return images_; }
  std::uint64_t fixes() const noexcept { return accepted_ - not_taken_; }

  flatbuffers::Offset<wire::Localizer> put(flatbuffers::FlatBufferBuilder& to,
                                           const std::string& camera) const;

  // Keys: images, accepted, share, fixes_sent, skipped, refused, reasons, latency_ms, query_ms
  // (p50, p95, max and by stage), rss_peak_bytes, calibration (JSON).
  std::string json(std::uint64_t rss_peak_bytes, const std::string& calibration = "null") const;
  // "95 fixes of 100 images; without one: few_matches 3, gathered 2"
  std::string text() const;

 private:
  std::uint64_t images_ = 0, accepted_ = 0, not_taken_ = 0, skipped_ = 0, refused_ = 0,
                without_pose_ = 0, searching_ = 0, lost_ = 0;
  Search search_;
  std::array<std::uint64_t, kReasons> reasons_{};
  Histogram latency_, query_;
  std::array<Histogram, kStages> stages_;
};

}  // namespace zonepack::localize
