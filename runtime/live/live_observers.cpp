// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_observers.hpp"

#include <utility>

#include "platform/process/clock.hpp"
#include "runtime/live/messages/print_line.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kNotes = 2048;

}  // namespace

LiveObservers::LiveObservers(Run& run, LiveControl& control, LiveMemory& memory, bool quiet)
    : notes(kNotes),
      events(notes, memory.served() ? &service.events : nullptr, control.overload),
      log_thread(notes, run),
      run_(run),
      control_(control),
      memory_(memory),
      messages_(quiet) {
  run.add_observer(recording);
  run.add_observer(messages_);
}

LiveObservers::~LiveObservers() {
  service.stop();
  log_thread.stop();
}

void LiveObservers::keep_habits(std::unique_ptr<HabitKeeper> keeper) {
  habits_ = std::move(keeper);
  if (!habits_) return;
  run_.add_observer(*habits_);
  recording.habits = [this] { return habits_->file(); };
}

std::optional<RunStart> LiveObservers::restore(const std::string& folder,
                                               const PoseFilterSettings& pose,
                                               std::int64_t now_ns) {
  if (folder.empty()) return std::nullopt;
  state_store_.emplace(folder);
  const Digest16 lineage = run_.accounted_map().catalog().lineage;
  const StateStore::Found found = state_store_->load(lineage);
  for (const std::string& note : found.notes) print_line(note);
  SavedState next;
  next.map_lineage = lineage;
  next.runs = 1 + (found.state ? found.state->runs : 0);
  const auto look = [this] {
    const LiveStatus now = control_.status.load();
    return StateGlimpse{now.now_ns, now.state.pose, now.state.map, now.state.zone};
  };
  const auto place = [this](const StateGlimpse& glimpse, SavedState& state) {
    const auto map = run_.find(glimpse.map);
    if (map == nullptr) return false;
    state.map_version = map->catalog().version;
    state.zone = glimpse.zone == kNoZone ? std::string() : map->model().graph.name(glimpse.zone);
    return true;
  };
  state_saver_.emplace(*state_store_, next, look, place, print_line);
  if (habits_) {
    state_saver_->also([this](bool at_end) { return habits_->save(monotonic_ns(), at_end); });
  }
  if (!found.state) return std::nullopt;
  const RestoredStart guess = guess_from(*found.state, pose);
  return RunStart{now_ns, guess.T_map_base, guess.sigma_m, guess.sigma_rad};
}

Outcome<void> LiveObservers::open_recording(const RecordingChoice& choice,
                                            const RecordingPreface& preface,
                                            std::uint32_t most_frames) {
  const std::size_t zones = run_.accounted_map().model().needs.size();
  const auto opened = recording.open(choice, preface, zones, most_frames);
  if (!opened) return opened.error();
  if (!opened->empty()) print_line(*opened);
  if (recording.tap() != nullptr) log_thread.add_task([this] { recording.drain(); });
  return {};
}

Outcome<void> LiveObservers::open_service(const ServeSettings& settings, const LineBoard& lines,
                                          const BuildInfo& build) {
  if (!memory_.served()) return {};
  service.lines = &lines;
  std::function<Result<std::uint64_t>(BoundedWriter&)> dump;
  if (FlightRecorder* const flight = recording.flight()) {
    dump = [flight](BoundedWriter& to) -> Result<std::uint64_t> {
      const auto dumped = flight->dump_to(to);
      if (!dumped) return dumped.error();
      return dumped->bytes;
    };
  }
  return service.open(settings, control_.status, memory_, run_.find(run_.accounted_map().number()),
                      std::move(dump), build);
}

Outcome<void> LiveObservers::start() {
  if (const auto started = log_thread.start(); !started) {
    return privilege_failure("log thread", started.error());
  }
  if (!state_saver_) return {};
  if (const auto started = state_saver_->start(); !started) {
    return privilege_failure("state", started.error());
  }
  return {};
}

Outcome<void> LiveObservers::serve(const Notifier& notifier) {
  const auto serving = service.start(notifier, [this] { return control_.loop().cycles(); });
  if (!serving) return privilege_failure("serve", serving.error());
  return {};
}

void LiveObservers::stop() {
  log_thread.stop();
  if (state_saver_) state_saver_->stop();
}

}  // namespace zonepack
