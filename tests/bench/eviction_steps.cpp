// SPDX-License-Identifier: Apache-2.0
// Evicts one zone of SLOTS slots among ZONES known ones, COUNT times, inside measured(): for
// counting its instructions, which must not depend on SLOTS or ZONES.
//
//   valgrind --tool=callgrind --toggle-collect='measured(*)' eviction_steps SLOTS ZONES COUNT
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "runtime/memory/residency.hpp"
#include "runtime/memory/slot_pool.hpp"

using zonepack::Eviction;
using zonepack::Purpose;
using zonepack::Residency;
using zonepack::SlotChain;
using zonepack::SlotPool;
using zonepack::ZoneId;

// Admits a zone for which the other one must go, whose slots go back among the free ones.
[[gnu::noinline]] void measured(Residency& memory, SlotPool& pool, ZoneId zone,
                                std::uint32_t slots) {
  const auto result =
      memory.admit(zone, {slots, 1}, Purpose::kApproach, [&pool](const Eviction& eviction) {
        SlotChain chain = eviction.slots;
        pool.give_back(chain);
      });
  if (!result) std::abort();
}

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: eviction_steps SLOTS ZONES COUNT\n");
    return 2;
  }
  const auto slots = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  const std::size_t zones = std::strtoul(argv[2], nullptr, 10);
  const unsigned long count = std::strtoul(argv[3], nullptr, 10);
  if (slots == 0 || zones < 2) return 2;

  Residency memory(zones, {slots, 0, 1, 0, {}, 0});
  SlotPool pool(slots);
  const ZoneId pair[2] = {0, static_cast<ZoneId>(zones - 1)};
  const auto load = [&](ZoneId zone) {
    SlotChain chain;
    if (!pool.take(slots, chain)) std::abort();
    memory.complete(zone, memory.generation(zone), chain);
  };
  if (!memory.admit(pair[1], {slots, 1}, Purpose::kApproach, [](const Eviction&) {})) return 1;
  load(pair[1]);
  for (unsigned long i = 0; i < count; ++i) {
    measured(memory, pool, pair[i % 2], slots);
    load(pair[i % 2]);
  }
  std::printf("%lu evictions\n", count);
  return 0;
}
