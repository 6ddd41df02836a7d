// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

namespace zonepack::localize {

// Says what goes wrong, but the same thing only once in kPause_ns, with the number of times: a
// camera that fails does so thirty times a second.
//
// Memory: the last kMost complaints.
class Complaints {
 public:
  static constexpr std::int64_t kPause_ns = 10'000'000'000;
  static constexpr std::size_t kMost = 16;

  explicit Complaints(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

  // `kind`: what makes it the same thing; its numbers may differ.
  void add(const std::string& kind, const std::string& text, std::int64_t now_ns) {
    for (Said& said : said_) {
      if (said.kind != kind) continue;
      ++said.since;
      if (now_ns - said.at_ns < kPause_ns) return;
      say_(text + (said.since > 1 ? " (" + std::to_string(said.since) + " times)" : ""));
      said.at_ns = now_ns;
      said.since = 0;
      return;
    }
    if (said_.size() == kMost) said_.pop_front();
    said_.push_back({kind, now_ns, 0});
    say_(text);
  }

 private:
  struct Said {
    std::string kind;
    std::int64_t at_ns;
    std::uint64_t since;
  };
  const std::function<void(const std::string&)> say_;
  std::deque<Said> said_;
};

}  // namespace zonepack::localize
