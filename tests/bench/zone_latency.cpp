// SPDX-License-Identifier: Apache-2.0
// From the decision to load a zone to its first usable signature, cold: a request to the robot's
// loader thread until its answer is ready to be published, compared with reading the zone's stored
// bytes as dd does (pread in pieces of 64 KiB, the kernel reading ahead as it likes). Multiples are
// of the zone's own dd, median of all rounds; dd's own multiples show how much this storage varies.
// Both are timed in a thread with the control thread's priority, where there is the privilege; that
// thread takes an answer with its next cycle, at most one period later. Before each, the pack's
// pages are dropped.
//
//   zone_latency MAP ROUNDS
// Reports whether the target of 1.5 at p99 is met, relative to dd's own p99 and to its median;
// exits with 1 when the median is over it.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform/memory/shared_memory.hpp"
#include "platform/process/clock.hpp"
#include "runtime/live/cycle/live_loader.hpp"
#include "tests/bench/bench_map.hpp"
#include "tests/support/page_cache.hpp"

namespace zonepack {
namespace {

using bench::fail;
using bench::most_slots;
using bench::open_map;

constexpr double kTarget = 1.5;

class Latency {
 public:
  explicit Latency(const std::string& folder)
      : catalog_(open_map(folder, kDefaultPayload)), shared_(lay_out()) {
    for (const CatalogZone& zone : catalog_.zones) paths_.push_back(folder + "/" + zone.pack);
    if (!loader_.start({.name = "loader", .fifo_priority = 40}, true)) fail("no loader thread");
  }

  bool run(int rounds) {
    std::vector<Times> dd(paths_.size()), load(paths_.size());
    for (int round = 0; round < rounds; ++round) {
      for (ZoneId zone = 0; zone < paths_.size(); ++zone) {
        for (int turn = 0; turn < 2; ++turn) {  // each goes first and second
          if (!test_support::make_cold(paths_[zone])) fail(paths_[zone] + " stays in the cache");
          if ((turn + round) % 2 == 0) {
            dd[zone].push_back(time_dd(zone) * 1e3);
          } else {
            load[zone].push_back(time_load(zone) * 1e3);
          }
        }
      }
    }
    return report(dd, load);
  }

 private:
  using Times = std::vector<double>;

  SharedMap lay_out() {
    const std::uint32_t slots = most_slots(catalog_);
    const auto zones = static_cast<std::uint32_t>(catalog_.zones.size());
    auto memory = SharedMemory::create("zone-latency", shared_map_bytes(zones, slots));
    if (!memory) fail("no memory");
    memory_.emplace(std::move(*memory));
    auto map = SharedMap::lay_out(memory_->bytes(), zones, slots);
    if (!map || !map->begin_map(zones)) fail("the memory cannot be laid out");
    return std::move(*map);
  }

  double time_dd(ZoneId zone) {
    const std::int64_t begin_ns = monotonic_ns();
    const int file = ::open(paths_[zone].c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail(paths_[zone] + " cannot be opened");
    while (::read(file, buffer_.data(), buffer_.size()) > 0) {
    }
    ::close(file);
    return seconds_since(begin_ns);
  }

  // Until the loader has filled the slots, by its own clock.
  double time_load(ZoneId zone) {
    const std::int64_t begin_ns = monotonic_ns();
    loader_.load({zone, ++generation_, catalog_.zones[zone].slots});
    const LoadResult result = answer();
    if (result.error.code != ErrorCode::kOk) {
      fail(paths_[zone] + ": " + to_string(result.error.code));
    }
    loader_.take_back(result.slots);
    return static_cast<double>(loader_.last_load().ns - begin_ns) * 1e-9;
  }

  LoadResult answer() {
    std::optional<LoadResult> result;
    while (!(result = loader_.poll())) sleep_until_ns(monotonic_ns() + 200'000);
    return *result;
  }

  static double seconds_since(std::int64_t begin_ns) {
    return static_cast<double>(monotonic_ns() - begin_ns) * 1e-9;
  }

  static double at(Times values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  }

  static void row(const char* name, const Times& values) {
    std::printf("%-26s", name);
    for (const double share : {0.5, 0.99, 0.999, 1.0}) std::printf(" %9.3f", at(values, share));
    std::printf("\n");
  }

  static const char* verdict(double times) { return times <= kTarget ? "met" : "MISSED"; }

  static bool report(const std::vector<Times>& dd, const std::vector<Times>& load) {
    Times all_dd, all_load, dd_over_dd, load_over_dd;
    for (std::size_t zone = 0; zone < dd.size(); ++zone) {
      const double middle = at(dd[zone], 0.5);
      for (const double ms : dd[zone]) {
        all_dd.push_back(ms);
        dd_over_dd.push_back(ms / middle);
      }
      for (const double ms : load[zone]) {
        all_load.push_back(ms);
        load_over_dd.push_back(ms / middle);
      }
    }
    std::printf("%-26s %9s %9s %9s %9s  (%zu cold loads)\n", "", "p50", "p99", "p99.9", "most",
                all_load.size());
    row("dd, ms", all_dd);
    row("decision to usable, ms", all_load);
    row("times dd", load_over_dd);
    row("dd itself, times dd", dd_over_dd);
    const double p99 = at(load_over_dd, 0.99);
    const double of_p99 = p99 / at(dd_over_dd, 0.99);
    std::printf("target %.1f at p99: %s with %.2f times dd's p99; %s with %.2f times dd's middle\n",
                kTarget, verdict(of_p99), of_p99, verdict(p99), p99);
    return at(load_over_dd, 0.5) <= kTarget;
  }

  Catalog catalog_;
  std::optional<SharedMemory> memory_;
  SharedMap shared_;
  LiveLoader loader_{catalog_, shared_};
  std::vector<std::string> paths_;
  std::vector<char> buffer_ = std::vector<char>(64 * 1024);
  std::uint32_t generation_ = 0;
};

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  const int rounds = argc == 3 ? std::atoi(argv[2]) : 0;
  if (rounds < 1) return std::fprintf(stderr, "usage: zone_latency MAP ROUNDS\n"), 2;
  try {
    zonepack::Latency latency(argv[1]);
    bool good = false;
    auto thread = zonepack::Thread::start({.name = "control", .fifo_priority = 80}, true,
                                          [&] { good = latency.run(rounds); });
    if (!thread) return std::fprintf(stderr, "zone_latency: no thread\n"), 1;
    thread->join();
    return good ? 0 : 1;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "zone_latency: %s\n", error.what()), 1;
  }
}
