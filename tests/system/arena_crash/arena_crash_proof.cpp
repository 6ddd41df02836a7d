// SPDX-License-Identifier: Apache-2.0
// A zoned that is killed with a reader attached, and its successor, inside a memory cgroup with
// room for one arena and a little: with a service manager, without one, and, to show that the limit
// would tell, by a successor that just takes new memory. Exits with 77 where it cannot be run.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <optional>

#include "runtime/memory/arena_memory.hpp"
#include "tests/support/service_manager.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/arena_crash/memory_group.hpp"

namespace zonepack::test_support {
namespace {

constexpr ByteCount kArena = 64 * kMiB;
constexpr ByteCount kLimit = kArena + 16 * kMiB;
constexpr int kTakenOver = 0, kNew = 1, kBusy = 2, kFailed = 3, kKilled = 9;

// A process that was killed, with the reader that it left behind.
struct Crashed {
  pid_t reader = -1;
};

pid_t start(const std::function<void()>& body) {
  const pid_t child = fork();
  if (child != 0) return child;
  body();
  _exit(kFailed);
}

int result_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : kKilled;
}

// The first zoned takes memory, a reader attaches, zoned is killed.
Crashed crash(const MemoryGroup& group, const ArenaMemory::Source& source) {
  int ready[2];
  ZP_REQUIRE(pipe(ready) == 0);
  const pid_t zoned = start([&] {
    if (!group.join()) return;
    std::optional<ArenaMemory> arena(ArenaMemory::obtain(kArena, source).value());
    auto memory = arena->reader_memory();
    const auto lock = arena->reader_presence();
    const pid_t reader = start([&] {
      arena.reset();
      const auto mapped = SharedMemory::map_read_only(std::move(memory).value());
      for (;;) pause();
    });
    ZP_REQUIRE(write(ready[1], &reader, sizeof reader) == sizeof reader);
    for (;;) pause();
  });
  Crashed crashed;
  ZP_REQUIRE(read(ready[0], &crashed.reader, sizeof crashed.reader) == sizeof crashed.reader);
  close(ready[0]);
  close(ready[1]);
  kill(zoned, SIGKILL);
  result_of(zoned);
  return crashed;
}

int restart(const MemoryGroup& group, const ArenaMemory::Source& source) {
  return result_of(start([&] {
    if (!group.join()) return;
    const auto arena = ArenaMemory::obtain(kArena, source);
    if (arena) _exit(arena->taken_over() ? kTakenOver : kNew);
    _exit(arena.error().code == ErrorCode::kBusy ? kBusy : kFailed);
  }));
}

void end(pid_t reader) {
  kill(reader, SIGKILL);
  result_of(reader);  // it became ours when its parent died
}

bool told(const char* what, bool good, const MemoryGroup& group) {
  std::printf("%-62s %s, peak %5.1f of %.1f MiB, limit hit %llu times\n", what, good ? "yes" : "NO",
              static_cast<double>(group.peak_bytes()) / kMiB, static_cast<double>(kLimit) / kMiB,
              static_cast<unsigned long long>(group.limit_hits()));
  return good;
}

bool with_manager(const TemporaryFolder& folder) {
  const auto group = MemoryGroup::make("zonepack-managed", kLimit);
  ServiceManager manager(folder / "notify");
  ArenaMemory::Source source{.lock_path = folder / "lock-1",
                             .wait = std::chrono::milliseconds(0),
                             .manager = &manager.notifier};
  const Crashed crashed = crash(*group, source);
  std::vector<HandedFile> handed = manager.hand_over();
  source.handed = &handed;
  const int result = restart(*group, source);
  const bool good = told("a managed zoned takes the memory over, its reader still attached",
                         result == kTakenOver && group->limit_hits() == 0, *group);
  end(crashed.reader);
  return good;
}

bool without_manager(const TemporaryFolder& folder) {
  const auto group = MemoryGroup::make("zonepack-alone", kLimit);
  const ArenaMemory::Source source{.lock_path = folder / "lock-2",
                                   .wait = std::chrono::milliseconds(0)};
  const Crashed crashed = crash(*group, source);
  const int refused = restart(*group, source);
  end(crashed.reader);
  ArenaMemory::Source patient = source;
  patient.wait = std::chrono::seconds(5);
  const int allowed = restart(*group, patient);
  return told("an unmanaged one is refused, and starts when the reader is gone",
              refused == kBusy && allowed == kNew && group->limit_hits() == 0, *group);
}

bool the_limit_would_tell(const TemporaryFolder& folder) {
  const auto group = MemoryGroup::make("zonepack-careless", kLimit);
  const ArenaMemory::Source source{.lock_path = folder / "lock-3",
                                   .wait = std::chrono::milliseconds(0)};
  const Crashed crashed = crash(*group, source);
  ArenaMemory::Source another = source;
  another.lock_path = folder / "lock-4";
  const int result = restart(*group, another);
  const bool good = told("one that takes new memory all the same hits the limit",
                         result != kNew && group->limit_hits() > 0, *group);
  end(crashed.reader);
  return good;
}

int run() {
  if (getuid() != 0 || !MemoryGroup::make("zonepack-try", kLimit)) {
    std::printf("not run: no memory cgroup that we may make a group in\n");
    return 77;
  }
  ZP_REQUIRE(prctl(PR_SET_CHILD_SUBREAPER, 1) == 0);
  const TemporaryFolder folder;
  const bool managed = with_manager(folder);
  const bool alone = without_manager(folder);
  const bool tells = the_limit_would_tell(folder);
  return managed && alone && tells ? 0 : 1;
}

}  // namespace
}  // namespace zonepack::test_support

int main() { return zonepack::test_support::run(); }
