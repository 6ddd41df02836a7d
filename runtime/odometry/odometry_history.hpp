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
    bool drift = false;  // the step is not known: odometry was missing
  };

  explicit OdometryHistory(std::size_t capacity);

  bool empty() const noexcept { return count_ == 0; }
  bool full() const noexcept { return count_ == entries_.size(); }
  std::uint64_t oldest() const noexcept { return first_; }
  std::uint64_t newest() const noexcept { return first_ + count_ - 1; }
  Entry& at(std::uint64_t index) noexcept { return entries_[place(index)]; }
  const Entry& at(std::uint64_t index) const noexcept { return entries_[place(index)]; }
  Entry& back() noexcept { return at(newest()); }
  const Entry& back() const noexcept { return at(newest()); }

  // Forgets everything and begins with one entry; numbering continues.
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

  // Cuts the step to entry `index` in two at t_ns, between its ends: entry `index` is then at t_ns,
  // and the old one and all after it move up by one. The oldest entry goes when full.
  void split(std::uint64_t index, std::int64_t t_ns) noexcept;

  // Spreads a motion that took from from_ns to to_ns, at constant speed, over those entries of
  // missing odometry at the end that began then or later, and adds an entry with what is left of
  // it. Of a motion that began before the first of them only the part since then counts, unless the
  // entries before were dropped for want of room. When fixes were used in between, the speed was
  // hardly constant: then the entries keep the uncertainty that they had. States are not replayed.
  // Returns the entry before the first that changed.
  std::uint64_t fill_drift(std::int64_t from_ns, std::int64_t to_ns,
                           const UncertainPose& motion) noexcept;

  // Recomputes the states after entry `from` from its state, the steps and the fixes.
  void replay_from(std::uint64_t from) noexcept;

 private:
  std::size_t place(std::uint64_t index) const noexcept {
    return static_cast<std::size_t>(index % entries_.size());
  }

  std::vector<Entry> entries_;
  std::uint64_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace zonepack
