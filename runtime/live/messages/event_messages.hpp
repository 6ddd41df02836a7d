// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "runtime/live/messages/line_allowance.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

// Prints a line for each event that people follow a run by: zones entered, loaded, evicted and
// refused, fixes refused, map_ready; and a warning, which says what to do, for each that calls for
// an action, also when no odometry has come kOdometryWithin_ns after the start. Quiet: warnings
// only.
//
// Lines come no faster than LineAllowance lets them, warnings on an allowance of their own, and
// none is printed while the output would make this thread wait; what is left out is counted, and
// the count is printed with the next line.
//
// Threads: the log thread.
class EventMessages final : public RunObserver {
 public:
  static constexpr std::int64_t kOdometryWithin_ns = 3'000'000'000;

  struct Output {
    std::function<bool()> ready;  // whether a line can be printed without waiting
    std::function<void(const std::string& line)> print;
    std::function<std::int64_t()> now_ns;  // steady
  };

  // To standard error.
  explicit EventMessages(bool quiet);
  EventMessages(bool quiet, Output output);

  void on_event(const Event& event, const MapVersion& map) noexcept override;
  void after_cycle(const CycleRecord& cycle, const MapVersion& map) noexcept override;

 private:
  struct Message {
    std::string text;  // empty: nothing to say
    bool warning = false;
  };
  Message message_of(const Event& event, const MapVersion& map);
  std::string loaded(const Event& event, const std::string& zone);
  void say(Message message, std::int64_t t_ns);

  const bool quiet_;
  const Output output_;
  LineAllowance news_, warnings_;
  std::uint64_t left_out_ = 0;
  std::map<std::pair<std::uint32_t, ZoneId>, std::int64_t> loads_;  // under way: when they began
  std::optional<std::int64_t> started_ns_;                          // the run's clock at its start
  std::int64_t t_ns_ = 0;  // of the last event, since the start
  bool map_ready_ = false;
  bool odometry_missing_ = false;  // and that was said
  bool odometry_came_ = false;
};

}  // namespace zonepack
