// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/fix_candidates.hpp"

#include <algorithm>
#include <utility>

namespace zonepack {
namespace {

// A given start holds until a fix agrees with it or two agree with each other.
int rank(const FixCandidates::Candidate& candidate) noexcept {
  if (candidate.fixes == 0) return 2;
  return static_cast<int>(candidate.fixes) * 2 + (candidate.near_guess ? 1 : 0) - 1;
}

// Of two with the same rank. A single fix does not replace an older one: either may be wrong, and
// the robot's zone would jump with each.
bool goes_first(const FixCandidates::Candidate& a, const FixCandidates::Candidate& b) noexcept {
  if (a.fixes == 1 && b.fixes == 1) return a.anchor < b.anchor;
  return a.anchor > b.anchor;
}

}  // namespace

void FixCandidates::guess(const OdometryHistory& history, const UncertainPose& pose) noexcept {
  all_[0] = {history.newest(), pose, pose, 0, 0, history.back().t_ns, false};
  count_ = 1;
}

// A free place, or that of the candidate with the fewest fixes, the oldest of these; never the
// guess, nor what is spared.
FixCandidates::Candidate& FixCandidates::place_for_new(const Candidate* spared) noexcept {
  if (count_ < all_.size()) return all_[count_++];
  Candidate* weakest = nullptr;
  for (Candidate& candidate : all_) {
    if (candidate.fixes == 0 || &candidate == spared) continue;
    if (weakest == nullptr || candidate.fixes < weakest->fixes ||
        (candidate.fixes == weakest->fixes && candidate.anchor < weakest->anchor)) {
      weakest = &candidate;
    }
  }
  return *weakest;
}

std::optional<FixCandidates::Candidate> FixCandidates::add(const OdometryHistory& history,
                                                           const UncertainPose& fix,
                                                           std::uint64_t index, double gate_chi2,
                                                           bool keep_first) noexcept {
  Candidate* best = nullptr;
  double least = gate_chi2;
  bool near_guess = false;
  UncertainPose best_prior, best_fix;
  for (std::size_t i = 0; i < count_; ++i) {
    Candidate& candidate = all_[i];
    const std::uint64_t at = std::max(index, candidate.anchor);
    const UncertainPose prior = history.carry(candidate.at_anchor, candidate.anchor, at);
    const UncertainPose later_fix = history.carry(fix, index, at);
    const double distance2 = mahalanobis2(prior, later_fix);
    if (candidate.fixes == 0) {
      near_guess = distance2 <= gate_chi2;
    } else if (distance2 <= least) {
      least = distance2;
      best = &candidate;
      best_prior = prior;
      best_fix = later_fix;
    }
  }
  if (best == nullptr) {
    place_for_new(keep_first ? first() : nullptr) = {
        index,     fix, history.carry(fix, index, history.newest()), 1, 1, history.at(index).t_ns,
        near_guess};
    return std::nullopt;
  }
  best->anchor = std::max(index, best->anchor);
  best->at_anchor = fuse(best_prior, best_fix);
  best->now = history.carry(best->at_anchor, best->anchor, history.newest());
  best->last_ns = std::max(best->last_ns, history.at(index).t_ns);
  ++best->fixes;
  ++best->run;
  return *best;
}

const FixCandidates::Candidate* FixCandidates::first() const noexcept {
  const Candidate* first = nullptr;
  for (std::size_t i = 0; i < count_; ++i) {
    const int higher = first == nullptr ? 1 : rank(all_[i]) - rank(*first);
    if (higher > 0 || (higher == 0 && goes_first(all_[i], *first))) first = &all_[i];
  }
  return first;
}

void FixCandidates::interrupt(std::int64_t t_ns) noexcept {
  const auto end = std::remove_if(all_.begin(), all_.begin() + count_, [t_ns](const Candidate& c) {
    return t_ns - c.last_ns > kMemory_ns;
  });
  count_ = static_cast<std::size_t>(end - all_.begin());
  for (std::size_t i = 0; i < count_; ++i) all_[i].run = 0;
}

std::size_t FixCandidates::list(std::array<PoseHypothesis, kMaxHypotheses>& into, std::size_t first,
                                std::uint32_t least_fixes) const noexcept {
  std::array<const Candidate*, kMaxHypotheses> order{};
  for (std::size_t i = 0; i < count_; ++i) order[i] = &all_[i];
  // Insertion sort.
  for (std::size_t i = 1; i < count_; ++i) {
    for (std::size_t j = i; j > 0; --j) {
      const int higher = rank(*order[j]) - rank(*order[j - 1]);
      if (higher < 0 || (higher == 0 && !goes_first(*order[j], *order[j - 1]))) break;
      std::swap(order[j], order[j - 1]);
    }
  }
  for (std::size_t i = 0; i < count_ && first < into.size(); ++i) {
    if (order[i]->fixes < least_fixes) continue;
    into[first++] = {order[i]->now.pose, order[i]->now.covariance, order[i]->fixes};
  }
  return first;
}

void FixCandidates::after_step(const UncertainPose& step) noexcept {
  for (std::size_t i = 0; i < count_; ++i) all_[i].now = compose(all_[i].now, step);
}

void FixCandidates::before_oldest_goes(const OdometryHistory& history) noexcept {
  const std::uint64_t oldest = history.oldest();
  for (std::size_t i = 0; i < count_; ++i) {
    if (all_[i].anchor != oldest) continue;
    all_[i].at_anchor = history.carry(all_[i].at_anchor, oldest, oldest + 1);
    ++all_[i].anchor;
  }
}

void FixCandidates::after_split(std::uint64_t index) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (all_[i].anchor >= index) ++all_[i].anchor;
  }
}

void FixCandidates::after_rewrite(const OdometryHistory& history) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    all_[i].now = history.carry(all_[i].at_anchor, all_[i].anchor, history.newest());
  }
}

void FixCandidates::after_restart(const OdometryHistory& history) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    all_[i].anchor = history.newest();
    all_[i].at_anchor = all_[i].now;
  }
}

bool FixCandidates::stand_on(std::uint64_t index) const noexcept {
  return std::any_of(all_.begin(), all_.begin() + count_,
                     [index](const Candidate& candidate) { return candidate.anchor == index; });
}

}  // namespace zonepack
