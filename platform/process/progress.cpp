// SPDX-License-Identifier: Apache-2.0
#include "platform/process/progress.hpp"

#include <algorithm>
#include <cstdio>

namespace zonepack {
namespace {

constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::size_t kBarWidth = 24;
constexpr char kClearLine[] = "\r\x1b[K";

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, seconds < 9.95 ? "%.1f s" : "%.0f s", seconds);
  return text;
}

}  // namespace

void Progress::start(std::string stage, std::size_t total, std::string unit) {
  stage_ = std::move(stage);
  unit_ = std::move(unit);
  total_ = total;
  done_ = 0;
  begin_ = drawn_ = Clock::now();
}

void Progress::advance(std::size_t count) {
  const std::size_t done = done_ += count;
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - drawn_ < kRedraw) return;
  drawn_ = now;
  draw(done, now);
}

void Progress::draw(std::size_t done, Clock::time_point now) {
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done) / elapsed;
  const std::size_t filled = total_ == 0 ? kBarWidth : kBarWidth * std::min(done, total_) / total_;
  const double left = rate > 0 ? static_cast<double>(total_ - std::min(done, total_)) / rate : 0;
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "%zu/%zu %s, %.*f/s, ", done, total_, unit_.c_str(),
                rate < 9.95 ? 1 : 0, rate);
  out_ << kClearLine << stage_ << " [" << std::string(filled, '#')
       << std::string(kBarWidth - filled, '.') << "] " << numbers << seconds_text(left) << " left"
       << std::flush;
}

void Progress::finish(const std::string& note) {
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (terminal_) out_ << kClearLine;
  out_ << stage_ << ": " << note << " in " << seconds_text(elapsed) << std::endl;
}

}  // namespace zonepack
