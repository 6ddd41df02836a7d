// SPDX-License-Identifier: Apache-2.0
// usage: fixed_work SECONDS MICROSECONDS PRIORITY: a thread under SCHED_FIFO that does the same
// piece of work every millisecond, one that takes so long when nothing is in its way, and measures
// how long it took. What this machine stalls of it, it stalls of any program. Prints one JSON
// object.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "platform/process/clock.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/run/figures/histogram.hpp"

namespace {

using zonepack::monotonic_ns;

constexpr std::int64_t kPeriod_ns = 1'000'000;

// Sums up 32 KiB, about what a cycle looks at, one line of the cache a step.
class Work {
 public:
  std::uint64_t steps(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      sum_ += ++memory_[at_];
      at_ = (at_ + 8) % memory_.size();
    }
    return sum_;
  }

 private:
  std::array<std::uint64_t, 4096> memory_{};
  std::uint64_t sum_ = 0;
  std::size_t at_ = 0;
};

// The least of many tries.
std::uint64_t steps_within(std::int64_t ns, Work& work, std::uint64_t& sum) {
  constexpr std::uint64_t kSteps = 2000;
  std::int64_t least = INT64_MAX;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t begin = monotonic_ns();
    sum += work.steps(kSteps);
    const std::int64_t took = monotonic_ns() - begin;
    if (took < least) least = took;
  }
  return kSteps * static_cast<std::uint64_t>(ns) /
         static_cast<std::uint64_t>(least < 1 ? 1 : least);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc == 4 ? std::atof(argv[1]) : 0,
               us = argc == 4 ? std::atof(argv[2]) : 0;
  const int priority = argc == 4 ? std::atoi(argv[3]) : 0;
  if (seconds <= 0 || us <= 0 || priority <= 0) {
    return std::fprintf(stderr, "usage: fixed_work SECONDS MICROSECONDS PRIORITY\n"), 2;
  }
  zonepack::Histogram histogram;
  Work work;
  std::uint64_t sum = 0;
  auto thread =
      zonepack::Thread::start({.name = "fixed-work", .fifo_priority = priority}, false, [&] {
        static_cast<void>(zonepack::lock_memory_now());
        const std::uint64_t steps = steps_within(static_cast<std::int64_t>(us * 1000), work, sum);
        const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
        for (std::int64_t next_ns = monotonic_ns(); next_ns < end_ns;) {
          zonepack::sleep_until_ns(next_ns);
          const std::int64_t begin = monotonic_ns();
          sum += work.steps(steps);
          const std::int64_t now_ns = monotonic_ns();
          histogram.add(now_ns - begin);
          while (next_ns <= now_ns) next_ns += kPeriod_ns;
        }
      });
  if (!thread) {
    return std::fprintf(stderr, "fixed_work: %s\n",
                        std::strerror(static_cast<int>(thread.error().detail))),
           1;
  }
  thread->join();
  const zonepack::TimingFigures figures = histogram.figures();
  const auto in_us = [](std::int64_t ns) { return static_cast<double>(ns) / 1000; };
  std::printf(
      "{\"p50\": %.1f, \"p99\": %.1f, \"p999\": %.1f, \"p9999\": %.1f, \"max\": %.1f, "
      "\"cycles\": %llu, \"sum\": %llu}\n",
      in_us(figures.p50), in_us(figures.p99), in_us(figures.p999), in_us(figures.p9999),
      in_us(figures.max), static_cast<unsigned long long>(figures.count),
      static_cast<unsigned long long>(sum));
  return 0;
}
