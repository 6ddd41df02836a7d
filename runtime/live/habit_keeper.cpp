// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/habit_keeper.hpp"

#include <utility>

#include "platform/files/atomic_file.hpp"
#include "platform/files/storage.hpp"
#include "runtime/run/inputs/run_inputs.hpp"

namespace zonepack {
namespace {

std::string path_in(const std::string& folder) { return folder + "/transitions.zpt"; }

// Of the file that a run goes on from: learning begins again where another one is given.
Digest16 origin_of(const LearnedTransitions* given) {
  return given == nullptr ? Digest16{} : blake2b_16(write_transitions(*given));
}

std::shared_ptr<const LearnedTransitions> begun_with(
    const std::shared_ptr<const LearnedTransitions>& given, const Digest16& lineage) {
  auto begun =
      given ? std::make_shared<LearnedTransitions>(*given) : std::make_shared<LearnedTransitions>();
  begun->map_lineage = lineage;
  begun->origin = origin_of(given.get());
  return begun;
}

}  // namespace

std::shared_ptr<const LearnedTransitions> go_on_learning(
    const std::string& folder, const std::shared_ptr<const LearnedTransitions>& given,
    const Digest16& map_lineage, std::vector<std::string>& notes) {
  if (given && given->map_lineage != map_lineage) return given;  // the map's model refuses it
  auto begun = begun_with(given, map_lineage);
  if (folder.empty()) {
    notes.push_back("preload.learn: what is learned is lost at the end; set state.folder");
    return begun;
  }
  const std::string path = path_in(folder);
  auto saved = load_transitions(path);
  if (!saved) {
    if (saved.error().code != ErrorCode::kNotFound) {
      notes.push_back(saved.error().message + "; going on without it, it will be written anew");
    }
    return begun;
  }
  if (saved->map_lineage != map_lineage) {
    notes.push_back(path + ": was learned on another map; going on without it");
  } else if (saved->origin != begun->origin) {
    notes.push_back(path +
                    ": preload.transitions names another file than it went on from; going "
                    "on from that one");
  } else {
    return std::make_shared<LearnedTransitions>(std::move(*saved));
  }
  return begun;
}

HabitKeeper::HabitKeeper(std::string folder, const std::shared_ptr<const LearnedTransitions>& begin)
    : folder_(std::move(folder)) {
  if (begin) learned_ = *begin;
}

void HabitKeeper::on_event(const Event& event, const MapVersion& map) noexcept {
  if (event.kind != EventKind::kZoneEntered || map.transitions() == nullptr) return;
  const std::lock_guard lock(mutex_);
  const ZoneGraph& graph = map.model().graph;
  if (map.number() != map_) {
    map_ = map.number();
    table_.emplace(graph);
    restore(learned_, *table_);
    steps_ = {};
  }
  const ZoneSteps::Step* const step = steps_.enter(graph, event.zone, event.t_ns);
  if (step == nullptr) return;
  table_->learn(step->before, step->now, step->next, step->stay_ns);
  const Digest16 origin = learned_.origin;
  // By name, so that it outlives this version of the map.
  learned_ = zonepack::save(*table_);
  learned_.map_lineage = map.catalog().lineage;
  learned_.map_version = map.catalog().version;
  learned_.origin = origin;
  changed_ = true;
}

std::vector<std::byte> HabitKeeper::file() const {
  const std::lock_guard lock(mutex_);
  return table_ ? write_transitions(learned_) : std::vector<std::byte>();
}

Result<void> HabitKeeper::save(std::int64_t now_ns, bool at_end) {
  if (folder_.empty()) return {};
  std::vector<std::byte> bytes;
  {
    const std::lock_guard lock(mutex_);
    if (!changed_ || (!at_end && saved_ns_ != 0 && now_ns - saved_ns_ < kPeriod_ns)) return {};
    bytes = write_transitions(learned_);
    changed_ = false;
    saved_ns_ = now_ns;
  }
  const auto saved = write_file_atomically(
      path_in(folder_), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (saved) return {};
  const std::lock_guard lock(mutex_);
  changed_ = true;
  return saved;
}

}  // namespace zonepack
