// SPDX-License-Identifier: Apache-2.0
// usage: map_readers SOCKET COUNT: programs of zonepack::client that read whatever zones zoned
// holds at SOCKET, where they stand, from when it is there until it ends. Prints what all of them
// read together as one JSON object; exits with 1 when one was told damage, crashed, or read
// nothing.
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "platform/process/clock.hpp"
#include "runtime/client/client.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kWait_ns = 30'000'000'000;
constexpr int kReadsBetweenQuestions = 64;

void nap_us(std::int64_t us) { sleep_until_ns(monotonic_ns() + us * 1000); }

struct Counts {
  std::atomic<std::uint64_t> good{0}, expired{0}, absent{0}, damaged{0}, leases{0}, bytes{0};
};

// Touches everything that is read most.
std::uint64_t bytes_of(const ZoneSignatures& signatures) {
  std::uint64_t bytes = 0;
  for (std::uint32_t i = 0; i < signatures.size(); ++i) {
    signatures[i].features().for_each(
        [&](const Feature& feature) { bytes += feature.descriptor.size() + 8 * sizeof(float); });
    if (const auto scan = signatures[i].scan()) {
      scan->points.for_each([&](ByteSpan row) { bytes += row.size(); });
    }
  }
  return bytes;
}

void read_until_zoned_ends(Client& client, std::uint32_t seed, Counts& counts) {
  std::minstd_rand engine(seed + 1);
  for (int turn = 1;; ++turn) {
    const auto zones = client.zones();
    if (!zones) {
      if (zones.error().code == ErrorCode::kBusy) continue;
      return;
    }
    const ZoneId zone = (*zones)[engine() % zones->size()].zone;
    if (turn % 2 == 0) {
      if (const auto lease = client.lease(zone)) {
        ++counts.leases;
        if (engine() % 2 == 0) static_cast<void>(client.release(*lease));  // or it runs out
      }
    }
    for (int i = 0; i < kReadsBetweenQuestions; ++i) {
      std::uint64_t bytes = 0;
      const auto some = i % 4 == 0 ? zone : (*zones)[engine() % zones->size()].zone;
      switch (client.read(some, [&](const ZoneSignatures& all) { bytes = bytes_of(all); })) {
        case ReadStatus::kOk:
          ++counts.good;
          counts.bytes += bytes;
          break;
        case ReadStatus::kExpired:
          ++counts.expired;
          break;
        case ReadStatus::kAbsent:
          ++counts.absent;
          break;
        case ReadStatus::kDamaged:
          ++counts.damaged;
          break;
      }
      nap_us(500);
    }
    const auto pose = client.pose();
    if (!pose && pose.error().code == ErrorCode::kCancelled) return;
  }
}

int reader(const std::string& socket, std::uint32_t number, Counts& counts) {
  for (const std::int64_t until_ns = monotonic_ns() + kWait_ns; monotonic_ns() < until_ns;) {
    auto client = Client::connect(socket, "reader-" + std::to_string(number));
    if (client) return read_until_zoned_ends(*client, number, counts), 0;
    nap_us(5000);
  }
  std::fprintf(stderr, "map_readers: no zoned at %s\n", socket.c_str());
  return 1;
}

using ull = unsigned long long;

int run(const std::string& socket, std::uint32_t count) {
  void* const page =
      mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (page == MAP_FAILED) return 1;
  Counts& counts = *new (page) Counts;
  std::vector<pid_t> pids;
  for (std::uint32_t i = 0; i < count; ++i) {
    const pid_t pid = fork();
    if (pid == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      _exit(reader(socket, i, counts));
    }
    pids.push_back(pid);
  }
  bool well = true;
  for (const pid_t pid : pids) {
    int status = 0;
    well = waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0 && well;
  }
  std::printf(
      "{\"readers\": %u, \"good\": %llu, \"expired\": %llu, \"absent\": %llu, \"damaged\": "
      "%llu, \"leases\": %llu, \"bytes\": %llu, \"ended_well\": %s}\n",
      count, ull{counts.good}, ull{counts.expired}, ull{counts.absent}, ull{counts.damaged},
      ull{counts.leases}, ull{counts.bytes}, well ? "true" : "false");
  return well && counts.good > 0 && counts.damaged == 0 ? 0 : 1;
}

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  const auto count = argc == 3 ? std::strtoul(argv[2], nullptr, 10) : 0;
  if (count == 0 || count > 1000) {
    return std::fprintf(stderr, "usage: map_readers SOCKET COUNT\n"), 2;
  }
  return zonepack::run(argv[1], static_cast<std::uint32_t>(count));
}
