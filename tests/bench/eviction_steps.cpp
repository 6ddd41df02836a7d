// SPDX-License-Identifier: Apache-2.0
// Evicts one zone of SLOTS slots COUNT times, among ZONES known zones and LEASES others that
// readers hold, inside measured(): for counting its instructions, which must not depend on any of
// these. Prints the nanoseconds of one eviction.
//
//   valgrind --tool=callgrind --toggle-collect='measured(*)' eviction_steps SLOTS ZONES LEASES
//   COUNT
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "platform/process/clock.hpp"
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
  if (argc != 5) {
    std::fprintf(stderr, "usage: eviction_steps SLOTS ZONES LEASES COUNT\n");
    return 2;
  }
  const auto slots = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  const std::size_t zones = std::strtoul(argv[2], nullptr, 10);
  const auto leases = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
  const unsigned long count = std::strtoul(argv[4], nullptr, 10);
  if (slots == 0 || zones < leases + 2) return 2;

  Residency memory(zones, {.budget = slots + leases,
                           .fixed = 0,
                           .slot_bytes = 1,
                           .max_signatures = 0,
                           .largest_pair = {},
                           .lease_ns = 1'000'000'000});
  SlotPool pool(slots + leases);
  const auto load = [&](ZoneId zone, std::uint32_t need) {
    SlotChain chain;
    if (!pool.take(need, chain)) std::abort();
    memory.complete(zone, memory.generation(zone), chain);
  };
  const auto keep = [](const Eviction&) { std::abort(); };
  for (ZoneId zone = 1; zone <= leases; ++zone) {
    if (!memory.admit(zone, {1, 1}, Purpose::kApproach, keep)) return 1;
    load(zone, 1);
    if (!memory.lease(zone, 0)) return 1;
  }
  const ZoneId pair[2] = {0, static_cast<ZoneId>(zones - 1)};
  if (!memory.admit(pair[1], {slots, 1}, Purpose::kApproach, keep)) return 1;
  load(pair[1], slots);
  std::int64_t took_ns = 0;
  for (unsigned long i = 0; i < count; ++i) {
    const std::int64_t begin_ns = zonepack::monotonic_ns();
    measured(memory, pool, pair[i % 2], slots);
    took_ns += zonepack::monotonic_ns() - begin_ns;
    load(pair[i % 2], slots);
  }
  std::printf("%lu evictions, %.0f ns each\n", count,
              static_cast<double>(took_ns) / static_cast<double>(count));
  return 0;
}
