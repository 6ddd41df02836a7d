// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/state/saved_state.hpp"

namespace zonepack {

// Two files in a folder, state-0 and state-1, of which the older one is replaced each time, by
// rename: power may fail at any moment, and if a file is lost or torn anyway, the one saved before
// it is still there. Something other than a regular file under one of the names, a link too, is
// neither read nor written to: the other one serves alone, or saving fails with EEXIST.
// Threads: one at a time; not for the control thread.
class StateStore {
 public:
  explicit StateStore(std::string folder) : folder_(std::move(folder)) {}

  struct Found {
    std::optional<SavedState> state;
    std::vector<std::string> notes;  // complete messages: what was not used, and why
  };
  // The newest state that is whole and belongs to this map. Makes the folder when it is missing.
  Found load(const Digest16& map_lineage);

  // Sets the sequence. kIo with errno; what was saved before stays. After load().
  Result<void> save(SavedState state);

  const std::string& folder() const noexcept { return folder_; }

 private:
  std::string path_of(unsigned place) const;

  std::string folder_;
  std::uint64_t next_sequence_ = 1;
  unsigned next_place_ = 0;
};

}  // namespace zonepack
