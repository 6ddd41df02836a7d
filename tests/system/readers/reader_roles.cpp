// SPDX-License-Identifier: Apache-2.0
#include "tests/system/readers/reader_roles.hpp"

#include <chrono>
#include <random>
#include <thread>

namespace zonepack::test_support {
namespace {

void pause() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

class ReaderRun {
 public:
  ReaderRun(Role role, const ZoneImages& images, const Blackboard& board)
      : role_(role), images_(images), board_(board) {}

  // Whether everything belonged to one image, and the zone was still the same when it was done.
  void read(ZoneId zone, const ZoneSignatures& signatures) {
    const std::uint32_t loads = board_.loads[zone].load();
    const auto loaded_anew = [&] { return board_.loads[zone].load() > loads + 1; };
    switch (role_) {
      case Role::kHangs:
        while (!loaded_anew() && !board_.done.load()) pause();
        break;
      case Role::kOverstays:
        while (!loaded_anew() && !board_.done.load()) images_.recognise(signatures);
        break;
      case Role::kOrdinary:
      case Role::kKilled:
        break;
    }
    whole = images_.recognise(signatures) < images_.size();
    outlived = loaded_anew();
  }

  bool whole = false;
  bool outlived = false;

 private:
  Role role_;
  const ZoneImages& images_;
  const Blackboard& board_;
};

}  // namespace

const char* to_string(Role role) {
  switch (role) {
    case Role::kOrdinary:
      return "ordinary";
    case Role::kHangs:
      return "hangs";
    case Role::kOverstays:
      return "overstays";
    case Role::kKilled:
      break;
  }
  return "is killed";
}

void run_reader(Role role, std::uint32_t seed, SharedReader& reader, const ZoneImages& images,
                const Blackboard& board, ReaderCounts& counts) {
  std::minstd_rand engine(seed + 1);
  while (!board.done.load()) {
    const auto zone = static_cast<ZoneId>(engine() % kZones);
    ReaderRun run(role, images, board);
    switch (reader.read(zone, [&](const ZoneSignatures& z) { run.read(zone, z); })) {
      case ReadStatus::kOk:
        ++counts.ok;
        counts.torn_accepted += !run.whole;
        // Reloaded before the check and still reported good: as bad as torn.
        counts.torn_accepted += run.outlived;
        break;
      case ReadStatus::kExpired:
        ++counts.expired;
        counts.torn_refused += !run.whole;
        break;
      case ReadStatus::kAbsent:
        ++counts.absent;
        pause();
        break;
      case ReadStatus::kDamaged:
        ++counts.damaged;
        break;
    }
    counts.outlived += run.outlived;
  }
}

}  // namespace zonepack::test_support
