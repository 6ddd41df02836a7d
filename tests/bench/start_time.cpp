// SPDX-License-Identifier: Apache-2.0
// From the start of the process to the first zone that another program can read, warm.
//
//   start_time ROUNDS SOCKET COMMAND...: COMMAND starts a zoned that serves at SOCKET
// Reports whether the target of 50 ms is met; exits with 1 when the median is over a quarter of a
// second.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "platform/process/clock.hpp"
#include "runtime/client/client.hpp"

extern char** environ;

namespace zonepack {
namespace {

constexpr double kTarget_ms = 50, kMost_ms = 250;
constexpr std::int64_t kMost_ns = 10'000'000'000;

bool some_zone_is_readable(Client& client) {
  const auto zones = client.zones();
  if (!zones) return false;
  for (const ZoneInfo& zone : *zones) {
    if (zone.signatures == 0) continue;
    std::size_t found = 0;
    const auto status =
        client.read(zone.zone, [&](const ZoneSignatures& all) { found = all.size(); });
    if (status == ReadStatus::kOk && found > 0) return true;
  }
  return false;
}

// Nothing when it did not come.
std::optional<double> start_once(const std::string& socket, char** command) {
  const std::int64_t begin_ns = monotonic_ns();
  pid_t pid = 0;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const int failed = posix_spawn(&pid, command[0], &quiet, nullptr, command, environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (failed != 0) return std::nullopt;
  std::optional<double> took_ms;
  while (!took_ms && monotonic_ns() - begin_ns < kMost_ns) {
    auto client = Client::connect(socket, "start");
    while (client && !took_ms && monotonic_ns() - begin_ns < kMost_ns) {
      if (some_zone_is_readable(*client)) {
        took_ms = static_cast<double>(monotonic_ns() - begin_ns) * 1e-6;
      }
      sleep_until_ns(monotonic_ns() + 200'000);
    }
    sleep_until_ns(monotonic_ns() + 200'000);
  }
  kill(pid, SIGTERM);
  waitpid(pid, nullptr, 0);
  return took_ms;
}

int run(int rounds, const std::string& socket, char** command) {
  if (Client::connect(socket, "start")) {
    return std::fprintf(stderr, "start_time: %s: a zoned serves there already: end it\n",
                        socket.c_str()),
           1;
  }
  std::vector<double> times;
  for (int round = -1; round < rounds; ++round) {  // the first one warms
    const auto took_ms = start_once(socket, command);
    if (!took_ms) return std::fprintf(stderr, "start_time: no zone was ever usable\n"), 1;
    if (round >= 0) times.push_back(*took_ms);
  }
  std::sort(times.begin(), times.end());
  const double middle = times[times.size() / 2];
  std::printf(
      "start to first zone usable, ms: %.1f least, %.1f in the middle, %.1f most of %zu; "
      "target %.0f: %s\n",
      times.front(), middle, times.back(), times.size(), kTarget_ms,
      middle <= kTarget_ms ? "met" : "MISSED");
  return middle <= kMost_ms ? 0 : 1;
}

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  const int rounds = argc > 3 ? std::atoi(argv[1]) : 0;
  if (rounds < 1) return std::fprintf(stderr, "usage: start_time ROUNDS SOCKET COMMAND...\n"), 2;
  return zonepack::run(rounds, argv[2], argv + 3);
}
