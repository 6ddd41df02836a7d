// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/log_feed.hpp"

#include <algorithm>

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kFramesAhead = 1024;
constexpr std::size_t kCorrectionsAhead = 256;
constexpr std::size_t kStackBytes = std::size_t{64} * 1024;  // it parses lines, and calls little
constexpr std::size_t kNotesOfACycle = 256;                  // far more than a cycle ever makes
constexpr std::int64_t kNap_ns = 50'000;

void nap() noexcept { sleep_until_ns(monotonic_ns() + kNap_ns); }

}  // namespace

LogFeed::LogFeed(CanFrameSource& frames, std::vector<PoseCorrection> corrections,
                 std::int64_t period_ns, const SpscQueue<LiveNote>& notes)
    : source_(frames),
      all_corrections_(std::move(corrections)),
      period_ns_(period_ns),
      notes_(notes),
      frames_(kFramesAhead),
      corrections_(kCorrectionsAhead) {}

LogFeed::~LogFeed() { stop(); }

Result<void> LogFeed::start() {
  first_ = source_.next();
  if (!first_) return ErrorCode::kNotFound;
  start_ns_ = first_->stamp_ns;
  auto thread =
      Thread::start({.name = "zoned-feed", .stack_bytes = kStackBytes}, true, [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void LogFeed::stop() noexcept {
  stop_.store(true);
  thread_.join();
}

void LogFeed::run() {
  for (auto frame = first_; frame; frame = source_.next()) {
    if (!feed(*frame)) return;
  }
  feed_corrections(fed_until_ns_.load() + period_ns_);
  done_.store(true, std::memory_order_release);
}

bool LogFeed::feed(const CanFrame& frame) {
  const std::int64_t until_ns = std::max(fed_until_ns_.load(), frame.stamp_ns);
  if (!feed_corrections(until_ns)) return false;
  dropped_.store(source_.dropped());
  while (!frames_.push(frame)) {
    if (stop_.load()) return false;
    nap();
  }
  fed_until_ns_.store(until_ns, std::memory_order_release);
  return true;
}

bool LogFeed::feed_corrections(std::int64_t until_ns) {
  while (corrections_fed_ < all_corrections_.size() &&
         all_corrections_[corrections_fed_].received_ns <= until_ns) {
    if (stop_.load()) return false;
    if (corrections_.push(all_corrections_[corrections_fed_])) {
      ++corrections_fed_;
    } else {
      nap();
    }
  }
  return true;
}

std::optional<CanFrame> LogFeed::Fed::next() noexcept {
  CanFrame frame;
  if (!feed_.frames_.pop(frame)) return std::nullopt;
  return frame;
}

std::int64_t LogFeed::cycle_time_ns(std::uint64_t cycle, std::int64_t) noexcept {
  const std::int64_t now_ns = start_ns_ + static_cast<std::int64_t>(cycle) * period_ns_;
  bus_.advance_to(now_ns);
  return now_ns;
}

bool LogFeed::await_inputs(std::uint64_t cycle) noexcept {
  const std::int64_t now_ns = start_ns_ + static_cast<std::int64_t>(cycle) * period_ns_;
  for (;;) {
    if (stop_.load(std::memory_order_relaxed)) return false;
    const bool done = done_.load(std::memory_order_acquire);
    const bool fed = done || fed_until_ns_.load(std::memory_order_acquire) > now_ns ||
                     frames_.free_space() == 0 || corrections_.free_space() == 0;
    if (fed && notes_.free_space() >= kNotesOfACycle) {
      return !done || cycle == 0 || bus_.next_arrival_ns().has_value();
    }
    nap();
  }
}

bool LogFeed::more() noexcept {
  return bus_.next_arrival_ns().has_value() || !done_.load(std::memory_order_acquire) ||
         frames_.size() > 0;
}

}  // namespace zonepack
