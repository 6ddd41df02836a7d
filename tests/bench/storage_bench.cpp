// SPDX-License-Identifier: Apache-2.0
// The ways of reading packs (ReadMode), cold and warm, compared with what dd does: pread in pieces
// of 64 KiB, the kernel reading ahead as it likes. "read" brings all chunks of the payload in
// windows of 64 KiB, "load" decodes them into slots (ZoneLoad). The ways take turns on every zone;
// before each cold one the pack's pages are dropped. Closing a pack, and so dropping its pages,
// counts. MB/s of stored bytes, in wall time; CPU is the thread's. Page cache: the most that
// mincore saw after any step, and what was left of all packs at the end; as root also the most that
// a memory cgroup of our own was charged for files.
//
//   storage_bench MAP [ROUNDS]
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/map/loader.hpp"
#include "runtime/memory/arena.hpp"
#include "tests/bench/bench_map.hpp"
#include "tests/support/page_cache.hpp"

namespace zonepack {
namespace {

using bench::BenchMap;
using bench::fail;

double now_s(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

struct Way {
  const char* name;
  bool plain;  // dd, without ReadMode
  ReadMode mode;
};
constexpr Way kWays[] = {{"dd", true, ReadMode::kCached},
                         {"direct", false, ReadMode::kDirect},
                         {"mapped", false, ReadMode::kMapped},
                         {"buffered", false, ReadMode::kBuffered},
                         {"cached", false, ReadMode::kCached}};
constexpr std::size_t kWayCount = std::size(kWays);

struct Figures {
  double cold_s = 0, cold_cpu_s = 0, warm_s = 0, warm_cpu_s = 0;
  std::vector<double> cold_over_dd;  // by zone and round
  std::uint64_t most_cached = 0, left_cached = 0, most_charged = 0;
};

// A memory cgroup (v1) with this process in it, as long as it exists.
class Cgroup {
 public:
  Cgroup() : path_("/sys/fs/cgroup/memory/zonepack_bench_" + std::to_string(::getpid())) {
    std::error_code error;
    if (!std::filesystem::create_directory(path_, error)) return;
    joined_ = put("/cgroup.procs", path_);
  }
  ~Cgroup() {
    if (joined_) put("/cgroup.procs", "/sys/fs/cgroup/memory");
    ::rmdir(path_.c_str());
  }
  bool joined() const { return joined_; }
  std::uint64_t cache() const {
    std::ifstream file(path_ + "/memory.stat");
    std::string key;
    for (std::uint64_t value; file >> key >> value;) {
      if (key == "cache") return value;
    }
    return 0;
  }

 private:
  static bool put(const char* file, const std::string& folder) {
    std::ofstream out(folder + file);
    out << ::getpid() << std::flush;
    return out.good();
  }
  std::string path_;
  bool joined_ = false;
};

class Bench {
 public:
  explicit Bench(const std::string& folder) : map_(folder, kDefaultPayload) {
    for (const CatalogZone& zone : map_.catalog.zones) {
      stored_ += zone.stored_bytes;
      paths_.push_back(folder + "/" + zone.pack);
    }
  }

  void run(int rounds, bool load) {
    std::vector<Figures> all(kWayCount);
    for (int round = 0; round < rounds; ++round) {
      for (ZoneId zone = 0; zone < paths_.size(); ++zone) {
        double dd = 0;
        for (std::size_t turn = 0; turn < kWayCount; ++turn) {
          // dd first, for the ratio; the others in turns.
          const std::size_t way =
              turn == 0 ? 0 : 1 + (turn + zone + static_cast<std::size_t>(round)) % (kWayCount - 1);
          Figures& figures = all[way];
          if (!test_support::make_cold(paths_[zone])) fail(paths_[zone] + " stays in the cache");
          const double cold = time(kWays[way], zone, load, figures.cold_cpu_s);
          figures.cold_s += cold;
          if (way == 0) dd = cold;
          figures.cold_over_dd.push_back(cold / dd);
          bring_in(paths_[zone]);
          figures.warm_s += time(kWays[way], zone, load, figures.warm_cpu_s);
        }
      }
    }
    watch(all, load);
    print(all, rounds, load);
  }

  std::uint64_t stored() const { return stored_; }

 private:
  std::span<std::byte> buffer() {
    void* at = memory_.data();
    std::size_t room = memory_.size();
    return {static_cast<std::byte*>(std::align(4096, kReadBufferBytes, at, room)),
            kReadBufferBytes};
  }

  void bring_in(const std::string& path) {
    if (!read_file(path, kMaxIndexBytes)) fail(path + " cannot be read");
  }

  double time(const Way& way, ZoneId zone, bool load, double& cpu) {
    const double begin = now_s(CLOCK_MONOTONIC), cpu_begin = now_s(CLOCK_THREAD_CPUTIME_ID);
    work(way, zone, load, [] {});
    cpu += now_s(CLOCK_THREAD_CPUTIME_ID) - cpu_begin;
    return now_s(CLOCK_MONOTONIC) - begin;
  }

  template <typename AfterStep>
  void work(const Way& way, ZoneId zone, bool load, AfterStep&& after_step) {
    if (way.plain) return plain(zone, after_step);
    if (!load) return windows(way, zone, after_step);
    Result<ZoneLoad> under_way =
        ZoneLoad::begin(map_.catalog, zone, map_.slots, buffer(), {way.mode, queue_.get()});
    if (!under_way) fail(paths_[zone] + ": " + to_string(under_way.error().code));
    for (;;) {
      const Result<bool> more = under_way->step();
      if (!more) fail(paths_[zone] + ": " + to_string(more.error().code));
      if (!*more) return;
      after_step();
    }
  }

  template <typename AfterStep>
  void plain(ZoneId zone, AfterStep&& after_step) {
    const int file = ::open(paths_[zone].c_str(), O_RDONLY | O_CLOEXEC);
    while (::read(file, buffer().data(), kReadBufferBytes) > 0) after_step();
    ::close(file);
  }

  template <typename AfterStep>
  void windows(const Way& way, ZoneId zone, AfterStep&& after_step) {
    Result<StorageFile> file = StorageFile::open(paths_[zone], way.mode, queue_.get());
    if (!file) fail(paths_[zone] + ": " + to_string(file.error().code));
    constexpr std::uint64_t kRoom = kReadBufferBytes;
    std::uint64_t asked = 0;
    for (std::uint64_t at = 0; at < file->size(); at += kRoom) {
      const std::uint64_t size = std::min(kRoom, file->size() - at);
      const ByteCount most = file->most_ahead();
      if (file->reads_ahead() && asked < file->size() && asked < at + size + most / 2) {
        const std::uint64_t start = std::max(at, asked);
        asked = std::min(file->size(), at + most);
        file->read_ahead(start, asked - start);
      }
      if (!file->read_window(at, size, buffer())) fail(paths_[zone] + " cannot be read");
      after_step();
    }
  }

  // Once more over all zones, cold, looking at the page cache after every step.
  void watch(std::vector<Figures>& all, bool load) {
    const Cgroup group;
    grouped_ = group.joined();
    for (std::size_t way = 0; way < kWayCount; ++way) {
      for (const std::string& path : paths_) test_support::make_cold(path);
      const std::uint64_t base = grouped_ ? group.cache() : 0;
      for (ZoneId zone = 0; zone < paths_.size(); ++zone) {
        int step = 0;
        work(kWays[way], zone, load, [&] {
          if (++step % 4 != 0) return;
          all[way].most_cached =
              std::max(all[way].most_cached, test_support::cached_bytes(paths_[zone]));
          const std::uint64_t charged = grouped_ ? group.cache() : 0;
          all[way].most_charged =
              std::max(all[way].most_charged, charged - std::min(base, charged));
        });
      }
      for (const std::string& path : paths_) {
        all[way].left_cached += test_support::cached_bytes(path);
      }
    }
  }

  void print(std::vector<Figures>& all, int rounds, bool load) {
    std::printf(
        "%-22s cold MB/s  CPU ms/MB  warm MB/s  CPU ms/MB   cold over dd p50    p99   "
        "cache most KiB   left KiB   cgroup most KiB\n",
        load ? "load" : "read");
    for (std::size_t way = 0; way < kWayCount; ++way) {
      Figures& figures = all[way];
      std::sort(figures.cold_over_dd.begin(), figures.cold_over_dd.end());
      const auto at = [&](double p) {
        return figures.cold_over_dd[static_cast<std::size_t>(
            p * static_cast<double>(figures.cold_over_dd.size() - 1) + 0.5)];
      };
      const double mb = static_cast<double>(stored_) * rounds / 1e6;
      std::printf("%-22s %9.0f  %9.3f  %9.0f  %9.3f   %16.2f %6.2f   %14llu %10llu   %15llu\n",
                  kWays[way].name, mb / figures.cold_s, figures.cold_cpu_s * 1e3 / mb,
                  mb / figures.warm_s, figures.warm_cpu_s * 1e3 / mb, at(0.5), at(0.99),
                  static_cast<unsigned long long>(figures.most_cached / 1024),
                  static_cast<unsigned long long>(figures.left_cached / 1024),
                  static_cast<unsigned long long>(figures.most_charged / 1024));
    }
    if (!grouped_) std::printf("no memory cgroup (v1) of our own here: its column says nothing\n");
    std::printf("\n");
  }

  BenchMap map_;
  std::vector<std::byte> memory_ = std::vector<std::byte>(kReadBufferBytes + 4096);
  std::unique_ptr<ReadQueue> queue_ = ReadQueue::make();
  std::vector<std::string> paths_;
  std::uint64_t stored_ = 0;
  bool grouped_ = false;
};

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: storage_bench MAP [ROUNDS]\n";
    return 2;
  }
  try {
    zonepack::Bench bench(argv[1]);
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 10;
    std::printf("%llu bytes in all packs' chunks, %d rounds\n\n",
                static_cast<unsigned long long>(bench.stored()), rounds);
    bench.run(rounds, false);
    bench.run(rounds, true);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
