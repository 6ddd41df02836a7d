// SPDX-License-Identifier: Apache-2.0
#include "runtime/state/state_store.hpp"

#include <cerrno>
#include <filesystem>

#include "platform/files/atomic_file.hpp"
#include "platform/files/file_kind.hpp"
#include "platform/files/storage.hpp"

namespace zonepack {

std::string StateStore::path_of(unsigned place) const {
  return folder_ + "/state-" + std::to_string(place);
}

StateStore::Found StateStore::load(const Digest16& map_lineage) {
  Found found;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  std::uint64_t newest = 0;
  for (const unsigned place : {0u, 1u}) {
    const std::string path = path_of(place);
    if (const auto other = not_a_regular_file(path)) {
      found.notes.push_back(path + ": is " + *other +
                            "; expected a file of zoned's own, or nothing: nothing is saved there; "
                            "remove it");
      continue;
    }
    const auto file = read_file(path, kMostStateBytes);
    if (!file && file.error().code == ErrorCode::kNotFound) continue;
    auto state = file ? read_state(*file) : Result<SavedState>(file.error());
    if (!state) {
      found.notes.push_back(path +
                            ": saved state cannot be used: " + to_string(state.error().code) +
                            "; going on without it, it will be written anew");
      continue;
    }
    if (state->sequence >= newest) {
      newest = state->sequence;
      next_place_ = 1 - place;
      next_sequence_ = newest + 1;
    }
    if (state->map_lineage != map_lineage) {
      found.notes.push_back(path + ": saved state belongs to another map (lineage " +
                            to_hex(state->map_lineage) + ", not " + to_hex(map_lineage) +
                            "); the robot's pose must be found anew");
      continue;
    }
    if (!found.state || state->sequence > found.state->sequence) found.state = *state;
  }
  return found;
}

Result<void> StateStore::save(SavedState state) {
  // A link would be followed, a pipe waited for.
  if (not_a_regular_file(path_of(next_place_))) next_place_ = 1 - next_place_;
  if (not_a_regular_file(path_of(next_place_))) return {ErrorCode::kIo, EEXIST};
  state.sequence = next_sequence_;
  const std::vector<std::byte> bytes = write_state(state);
  const auto saved = write_file_atomically(
      path_of(next_place_), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!saved) return saved;
  ++next_sequence_;
  next_place_ = 1 - next_place_;
  return {};
}

}  // namespace zonepack
