// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/odometry/se2.hpp"

namespace zonepack {

// The last seconds of dead reckoning, one entry per step, with the filter's state at each.
// Entries are numbered from the start of the run; times never fall from one to the next.
// Real-time: memory is taken in the constructor; the oldest entry gives way to a new one.
class OdometryHistory {
 public:
  struct Entry {
    std::int64_t t_ns = 0;
    UncertainPose step;   // motion since the entry before
    UncertainPose state;  // T_map_base at t_ns, fixes included
    UncertainPose fix;    // the fixes used here, if has_fix
    bool has_fix = false;
  };

  explicit OdometryHistory(std::size_t capacity);

  bool empty() const noexcept { return count_ == 0; }
  bool full() const noexcept { return count_ == entries_.size(); }
  std::uint64_t oldest() const noexcept { return first_; }
  std::uint64_t newest() const noexcept { return first_ + count_ - 1; }
  Entry& at(std::uint64_t index) noexcept { return entries_[index % entries_.size()]; }
  const Entry& at(std::uint64_t index) const noexcept { return entries_[index % entries_.size()]; }
  Entry& back() noexcept { return at(newest()); }
  const Entry& back() const noexcept { return at(newest()); }

  // Forgets everything and begins with one entry; numbers go on.
  void restart(std::int64_t t_ns) noexcept;

  // Adds an entry at t_ns, not before back().t_ns, dropping the oldest when full.
  Entry& push(std::int64_t t_ns, const UncertainPose& step) noexcept;

  // The first entry at or after t_ns; nullopt when t_ns lies outside the history.
  std::optional<std::uint64_t> find(std::int64_t t_ns) const noexcept;

  // A pose that held at t_ns, carried to entry `index`, the one that find(t_ns) gave.
  UncertainPose carry_to_entry(const UncertainPose& pose, std::int64_t t_ns,
                               std::uint64_t index) const noexcept;

  // A pose at entry `from`, carried along the steps to entry `to` (from <= to).
  UncertainPose carry(UncertainPose pose, std::uint64_t from, std::uint64_t to) const noexcept;

  // States after entry `from` anew from its state, steps and fixes.
  void replay_from(std::uint64_t from) noexcept;

 private:
  std::vector<Entry> entries_;
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace zonepack
