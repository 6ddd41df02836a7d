// SPDX-License-Identifier: Apache-2.0
// usage: readers_proof EVICTIONS: eight processes read zones in place, three of them badly, while
// zones are evicted and loaded EVICTIONS times under a budget. Prints a table; exits with 1 when a
// mixed read was accepted, the budget was exceeded, or a reader crashed.
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <new>
#include <random>
#include <string>

#include "platform/base/require.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/memory/residency.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/system/readers/reader_roles.hpp"

namespace zonepack::test_support {
namespace {

constexpr std::uint32_t kSlots = 24;  // for 24 zones of 1 to 5 slots: never all
constexpr std::array kRoles = {Role::kOrdinary, Role::kOrdinary, Role::kOrdinary,  Role::kOrdinary,
                               Role::kOrdinary, Role::kHangs,    Role::kOverstays, Role::kKilled};

// Zones come and go as residency decides.
class Writer {
 public:
  Writer(SharedMemory& memory, const ZoneImages& images, Blackboard& board)
      : images_(images),
        board_(board),
        zones_(memory.bytes(), kZones, kSlots),
        residency_(kZones, {.budget = kSlots * kSlotBytes,
                            .fixed = 0,
                            .slot_bytes = kSlotBytes,
                            .max_signatures = 0,
                            .largest_pair = {},
                            .lease_ns = 40}) {}

  // One wanted zone, one tick of the clock.
  void step() {
    ++now_ns_;
    residency_.expire_leases(now_ns_);
    const auto zone = static_cast<ZoneId>(engine_() % kZones);
    if (engine_() % 4 == 0) lease(zone);
    if (residency_.resident(zone)) {
      residency_.touch(zone);
      return;
    }
    const std::uint32_t image = (zone * 5 + residency_.generation(zone) + 1) % images_.size();
    const auto purpose = engine_() % 2 == 0 ? Purpose::kOwnZone : Purpose::kApproach;
    const ZoneNeed need{images_.slots(image), images_.signatures(image)};
    const auto admitted = residency_.admit(zone, need, purpose, [&](const Eviction& evicted) {
      zones_.map().withdraw(evicted.zone);
      zones_.give_back(evicted.slots);
      ++evictions_;
    });
    most_charged_ = std::max(most_charged_, residency_.charged());
    if (!admitted) {
      ++waits_;
      return;
    }
    const SlotChain chain = zones_.fill(images_.chunks(image));
    residency_.complete(zone, residency_.generation(zone), chain);
    zones_.map().publish(zone, residency_.generation(zone), chain);
    ++board_.loads[zone];
    ZP_REQUIRE(zones_.free_slots() + residency_.used_sum().slots == kSlots);
  }

  std::uint64_t evictions() const { return evictions_; }
  std::uint64_t waits() const { return waits_; }
  ByteCount most_charged() const { return most_charged_; }
  const Residency& residency() const { return residency_; }

 private:
  // For readers that release it, and for some that never do.
  void lease(ZoneId zone) {
    const auto lease = residency_.lease(zone, now_ns_);
    if (lease && engine_() % 2 == 0) residency_.release(*lease);
  }

  const ZoneImages& images_;
  Blackboard& board_;
  SharedZones zones_;
  Residency residency_;
  std::minstd_rand engine_{1};
  std::int64_t now_ns_ = 0;
  std::uint64_t evictions_ = 0, waits_ = 0;
  ByteCount most_charged_ = 0;
};

class Readers {
 public:
  Readers(const SharedMemory& memory, const ZoneImages& images, Blackboard& board)
      : memory_(memory), images_(images), board_(board) {
    for (std::size_t i = 0; i < kRoles.size(); ++i) start(i);
  }

  // Kills the reader whose role is to be killed, and starts another in its place.
  void kill_one() {
    const std::size_t last = kRoles.size() - 1;
    const ReaderCounts& counts = board_.readers[last];
    const auto reads = [&] { return counts.ok + counts.expired; };
    // Nothing is evicted meanwhile, so the first of them comes to a good read however slow it is.
    while (counts.ok == 0 || reads() == reads_at_start_) usleep(100);
    kill(pids_[last], SIGKILL);
    waitpid(pids_[last], nullptr, 0);
    ++kills_;
    reads_at_start_ = reads();
    start(last);
  }

  // True when all of them exited by themselves.
  bool join() {
    bool good = true;
    for (const pid_t pid : pids_) {
      int status = 0;
      waitpid(pid, &status, 0);
      good = good && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }
    return good;
  }
  std::uint64_t kills() const { return kills_; }

 private:
  void start(std::size_t place) {
    pids_[place] = fork();
    if (pids_[place] != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int niceness = nice(5);
    static_cast<void>(niceness);
    const auto mapped = SharedMemory::map_read_only(memory_.reader_file().value());
    auto reader = SharedReader::open(mapped->read_only()).value();
    const auto seed = static_cast<std::uint32_t>(place * 1000 + kills_);
    run_reader(kRoles[place], seed, reader, images_, board_, board_.readers[place]);
    _exit(0);
  }

  const SharedMemory& memory_;
  const ZoneImages& images_;
  Blackboard& board_;
  std::array<pid_t, kRoles.size()> pids_{};
  std::uint64_t kills_ = 0;
  std::uint64_t reads_at_start_ = 0;
};

using ull = unsigned long long;

bool report(const Blackboard& board, const Writer& writer, const Readers& readers) {
  std::printf("%-10s %10s %10s %10s %8s %14s %14s %9s\n", "reader", "good", "expired", "absent",
              "damaged", "mixed, refused", "mixed, taken", "outlived");
  bool good = true, saw_mixed = false;
  for (std::size_t i = 0; i < kRoles.size(); ++i) {
    const ReaderCounts& c = board.readers[i];
    std::printf("%-10s %10llu %10llu %10llu %8llu %14llu %14llu %9llu\n", to_string(kRoles[i]),
                ull{c.ok}, ull{c.expired}, ull{c.absent}, ull{c.damaged}, ull{c.torn_refused},
                ull{c.torn_accepted}, ull{c.outlived});
    good = good && c.torn_accepted == 0 && c.damaged == 0;
    saw_mixed = saw_mixed || c.torn_refused > 0;
    const bool outlives = kRoles[i] == Role::kHangs || kRoles[i] == Role::kOverstays;
    good = good && (outlives ? c.outlived > 0 : c.ok > 0);
  }
  const ByteCount budget = writer.residency().limits().budget;
  std::printf("evictions %llu, loads %llu, waits for room %llu, leases revoked %llu, kills %llu\n",
              ull{writer.evictions()}, ull{writer.residency().counters().zones_loaded},
              ull{writer.waits()}, ull{writer.residency().counters().leases_revoked},
              ull{readers.kills()});
  std::printf("most charged %llu of %llu bytes\n", ull{writer.most_charged()}, ull{budget});
  if (!saw_mixed) std::printf("no read was ever mixed: this run shows nothing\n");
  return good && saw_mixed && writer.most_charged() <= budget && readers.kills() > 0;
}

int run(std::uint64_t evictions) {
  const ZoneImages images(12);
  auto memory = SharedMemory::create("zonepack-proof", shared_map_bytes(kZones, kSlots)).value();
  void* const page =
      mmap(nullptr, sizeof(Blackboard), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ZP_REQUIRE(page != MAP_FAILED);
  Blackboard& board = *new (page) Blackboard{};
  Writer writer(memory, images, board);
  Readers readers(memory, images, board);
  std::uint64_t next_kill = evictions / 20;
  for (std::uint64_t step = 0; writer.evictions() < evictions; ++step) {
    writer.step();
    if (step % 8 == 0) usleep(50);  // readers get to read
    if (writer.evictions() >= next_kill) {
      readers.kill_one();
      next_kill += evictions / 20 + 1;
    }
  }
  board.done = true;
  const bool ended_well = readers.join();
  if (!ended_well) std::printf("a reader crashed\n");
  return report(board, writer, readers) && ended_well ? 0 : 1;
}

}  // namespace
}  // namespace zonepack::test_support

int main(int argc, char** argv) {
  const unsigned long long evictions = argc == 2 ? std::strtoull(argv[1], nullptr, 10) : 0;
  if (evictions < 100) {
    std::fprintf(stderr, "usage: readers_proof EVICTIONS (at least 100)\n");
    return 2;
  }
  return zonepack::test_support::run(evictions);
}
