// SPDX-License-Identifier: Apache-2.0
// Drives a recording's inputs through the cycle in one thread, each run of it inside measured(),
// for counting its instructions (instructions.sh). Prints what each cycle was given: its number,
// frames, corrections, loads and commands, and how many events it produced.
//
//   recorded_cycles RECORDING [CYCLES]
#include <cstdio>
#include <cstdlib>
#include <string>

#include "platform/memory/shared_memory.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/replay/recorded_loader.hpp"
#include "runtime/replay/recorded_run.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

using namespace zonepack;

namespace {

// Copies events into a queue, as on the robot.
class QueuedEvents final : public EventSink {
 public:
  void on_event(const Event& event) noexcept override { queue_.push(event); }
  int drain() {
    int count = 0;
    for (Event event; queue_.pop(event);) ++count;
    return count;
  }

 private:
  SpscQueue<Event> queue_{2048};
};

int fail(const std::string& what) {
  std::fprintf(stderr, "recorded_cycles: %s\n", what.c_str());
  return 1;
}

}  // namespace

// Returns a result, so that the call does not become a tail jump that never returns.
[[gnu::noinline]] std::uint64_t measured(Cycle& cycle, const CycleInput& input) {
  return cycle.run(input).cycles;
}

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: recorded_cycles RECORDING [CYCLES]\n"), 2;
  const std::uint64_t wanted = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : UINT64_MAX;
  auto recording = RecordingReader::open(argv[1]);
  if (!recording) return fail(recording.error().message);
  if (recording->checkpoint()) return fail("the recording does not begin with cycle 0");
  const auto run = open_recorded_run(recording->preface());
  if (!run) return fail(run.error().message);
  const auto made = MapModel::make(run->catalog, recording->preface().terms);
  if (!made) return fail(made.error().message);
  const MapModel* const map = made->get();

  const auto zones = static_cast<std::uint32_t>(map->needs.size());
  auto memory = SharedMemory::create("recorded", shared_map_bytes(zones, map->slots));
  if (!memory) return fail("no memory");
  auto shared = SharedMap::lay_out(memory->bytes(), zones, map->slots);
  if (!shared || !shared->begin_map(zones)) return fail("the memory cannot be laid out");
  Residency residency(zones, map->limits);
  RecordedLoader loader(run->catalog);
  QueuedEvents events;
  if (const auto pinned = map->pin(residency); !pinned) return fail(pinned.error().message);
  Cycle cycle(cycle_config(run->settings), {map->graph, map->needs, map->load_s, map->pinned,
                                            residency, loader, events, &*shared});
  if (const auto& start = recording->preface().start) {
    cycle.start_at(start->now_ns, start->T_map_base,
                   start->sigma_m.value_or(run->settings.pose.start_sigma_m),
                   start->sigma_rad.value_or(run->settings.pose.start_sigma_rad));
  }
  while (const RecordedInput* const input = recording->next()) {
    if (input->offer.map != 0) return fail("the map changes in it; take a recording of one map");
    for (const LoadResult& load : input->loads) {
      if (!loader.answer(load)) return fail("the recording is another version's");
    }
    const std::uint64_t done = measured(cycle, input->view());
    std::printf("%llu %zu %zu %zu %zu %d\n", static_cast<unsigned long long>(done - 1),
                input->frames.size(), input->corrections.size(), input->loads.size(),
                input->commands.size(), events.drain());
    if (done == wanted) return 0;
  }
  return recording->complete() ? 0 : fail(recording->note());
}
