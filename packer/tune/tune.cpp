// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/tune.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace zonepack::packer::tune {
namespace {

constexpr std::size_t kMostRejected = 20;

// One drive is judged by what was chosen on others.
struct Fold {
  std::vector<std::size_t> training;
  std::size_t held_out = 0;
};

std::vector<Fold> folds_of(std::size_t tracks, bool halves) {
  std::vector<Fold> folds;
  if (halves) return {{{0}, 1}};
  for (std::size_t held = 0; held < tracks; ++held) {
    Fold& fold = folds.emplace_back();
    fold.held_out = held;
    for (std::size_t i = 0; i < tracks; ++i) {
      if (i != held) fold.training.push_back(i);
    }
  }
  return folds;
}

std::int64_t signed_of(std::uint64_t value) { return static_cast<std::int64_t>(value); }

Saved saved(const DriveCost& before, const DriveCost& after) {
  return {signed_of(before.loads) - signed_of(after.loads),
          signed_of(before.signatures) - signed_of(after.signatures),
          signed_of(before.stored) - signed_of(after.stored)};
}

void operator+=(Saved& sum, const Saved& other) {
  sum.loads += other.loads;
  sum.signatures += other.signatures;
  sum.stored += other.stored;
}

// A change tried on all tracks.
struct Trial {
  Change change;
  ChangeNames names;
  Smallest smallest;
  std::vector<DriveCost> drives;
};

// The cuts of one zone, or one merge.
struct Family {
  std::vector<Trial> trials;
};

class Tuner {
 public:
  Tuner(Layout layout, std::vector<Track> tracks, bool halves,
        std::span<const Signature> signatures, const Options& options, const Weigh& weigh,
        const Fault& fault, Progress& progress)
      : signatures_(signatures),
        options_(options),
        weigh_(weigh),
        fault_(fault),
        progress_(progress),
        folds_(folds_of(tracks.size(), halves)) {
    result_.layout = std::move(layout);
    result_.tracks = std::move(tracks);
    result_.halves = halves;
    std::set<std::size_t> chosen_on;
    for (const Fold& fold : folds_) {
      chosen_on.insert(fold.training.begin(), fold.training.end());
    }
    training_.assign(chosen_on.begin(), chosen_on.end());
  }

  Tuned run() {
    result_.before = total();
    now_ = result_.before;
    while (step()) {
    }
    result_.after = now_;
    for (auto& [key, rejected] : rejected_) result_.rejected.push_back(std::move(rejected));
    std::ranges::stable_sort(result_.rejected, [](const Step& a, const Step& b) {
      return a.judgement.training.stored > b.judgement.training.stored;
    });
    if (result_.rejected.size() > kMostRejected) result_.rejected.resize(kMostRejected);
    return std::move(result_);
  }

 private:
  bool feasible(const Smallest& smallest) const { return smallest.bytes <= options_.budget; }

  double price(const DriveCost& cost) const {
    return static_cast<double>(cost.stored) +
           static_cast<double>(cost.loads) * static_cast<double>(options_.load_bytes);
  }
  double price(const std::vector<DriveCost>& drives, const std::vector<std::size_t>& which) const {
    double sum = 0;
    for (const std::size_t i : which) sum += price(drives[i]);
    return sum;
  }

  Total total() const {
    Total total;
    total.zones = result_.layout.living();
    total.smallest = smallest_of(result_.layout);
    const std::uint64_t room = room_in(result_.layout, total.smallest, options_.budget);
    for (const Track& track : result_.tracks) {
      total.drives.push_back(cost_of(track.visits, result_.layout, room));
      total.visits.push_back(track.visits.size());
      total.sum += total.drives.back();
    }
    return total;
  }

  Trial trial_of(const Change& change, const Changed& changed) const {
    Trial trial{change, changed.names, smallest_of(changed.layout), {}};
    const std::uint64_t room = room_in(changed.layout, trial.smallest, options_.budget);
    for (const Track& track : result_.tracks) {
      trial.drives.push_back(cost_of(visits_after(track, change, changed), changed.layout, room));
    }
    return trial;
  }

  std::vector<std::vector<Change>> candidates() const {
    const Layout& layout = result_.layout;
    std::vector<std::vector<Change>> families;
    for (std::uint32_t zone = 0; zone < layout.zones.size(); ++zone) {
      std::vector<Change> cuts = splits_of(layout, signatures_, zone, options_.cuts);
      if (!cuts.empty()) families.push_back(std::move(cuts));
    }
    if (feasible(now_.smallest)) {
      for (const Change& merge : merges_of(layout)) families.push_back({merge});
    }
    return families;
  }

  // Tries everything; families whose every change is impossible are left out.
  std::vector<Family> try_all() {
    const std::vector<std::vector<Change>> changes = candidates();
    std::size_t count = 0;
    for (const auto& family : changes) count += family.size();
    const bool fits = feasible(now_.smallest);
    progress_.start("round " + std::to_string(++round_), count, "changes");
    std::vector<Family> families;
    for (const auto& family : changes) {
      Family tried;
      for (const Change& change : family) {
        progress_.advance();
        const std::optional<Changed> after = changed(result_.layout, signatures_, change);
        if (!after) continue;
        Trial trial = trial_of(change, *after);
        if (fits && !feasible(trial.smallest)) continue;
        const bool merges = change.kind == Change::Kind::kMerge;
        if (merges && trial.smallest.bytes > now_.smallest.bytes) continue;
        tried.trials.push_back(std::move(trial));
      }
      if (!tried.trials.empty()) families.push_back(std::move(tried));
    }
    tried_ = count;
    return families;
  }

  const Trial& best_on(const Family& family, const std::vector<std::size_t>& tracks) const {
    return *std::ranges::min_element(
        family.trials, {}, [&](const Trial& trial) { return price(trial.drives, tracks); });
  }

  // Chosen without a drive, judged on it, each in turn.
  Judgement judge(const Family& family, const Trial& chosen) const {
    Judgement judgement;
    for (const std::size_t i : training_) {
      judgement.training += saved(now_.drives[i], chosen.drives[i]);
    }
    for (const Fold& fold : folds_) {
      const Trial& best = best_on(family, fold.training);
      const DriveCost &before = now_.drives[fold.held_out], &after = best.drives[fold.held_out];
      judgement.held_out += saved(before, after);
      if (price(after) < price(before)) ++judgement.helped;
      if (price(after) > price(before)) ++judgement.hurt;
    }
    return judgement;
  }

  double worth(const Saved& saved) const {
    return static_cast<double>(saved.stored) +
           static_cast<double>(saved.loads) * static_cast<double>(options_.load_bytes);
  }

  bool holds(const Judgement& judgement) const {
    return worth(judgement.held_out) > 0 && judgement.helped >= judgement.hurt;
  }
  bool pays(const std::vector<DriveCost>& drives) const {
    const double before = price(now_.drives, training_);
    return before - price(drives, training_) >= kLeastGain * before && before > 0;
  }

  static std::string key_of(const ChangeNames& names) {
    std::string key;
    for (const std::string& name : names.from) key += name + "/";
    return key;
  }

  Step step_of(const Trial& trial, const Judgement& judgement, std::string reason) const {
    return {trial.change.kind,
            trial.names,
            signed_of(now_.smallest.bytes) - signed_of(trial.smallest.bytes),
            !feasible(now_.smallest),
            judgement,
            std::move(reason)};
  }

  // The change with its zones packed; nullopt when it fails there, which is noted.
  std::optional<Changed> packed(const Trial& trial, const Judgement& judgement, Trial& exact) {
    std::optional<Changed> after = changed(result_.layout, signatures_, trial.change);
    for (const std::uint32_t zone : after->fresh) {
      after->layout.zones[zone].cost = weigh_(after->layout.zones[zone]);
    }
    exact = trial_of(trial.change, *after);
    std::string reason = fault_(after->layout);
    if (reason.empty()) return after;
    rejected_[key_of(trial.names)] = step_of(trial, judgement, std::move(reason));
    return std::nullopt;
  }

  void make(Changed changed, const Trial& exact, const Judgement& judgement) {
    Step made = step_of(exact, judgement, "");
    made.judgement.training = {};
    for (const std::size_t i : training_) {
      made.judgement.training += saved(now_.drives[i], exact.drives[i]);
    }
    for (Track& track : result_.tracks) follow(track, exact.change, changed);
    result_.layout = std::move(changed.layout);
    now_ = total();
    for (const std::string& name : made.names.from) {
      std::erase_if(rejected_, [&](const auto& entry) {
        const auto& from = entry.second.names.from;
        return std::ranges::find(from, name) != from.end();
      });
    }
    std::string note = made.kind == Change::Kind::kSplit ? "cuts " : "joins ";
    for (std::size_t i = 0; i < made.names.from.size(); ++i) {
      note += (i == 0 ? "" : " and ") + made.names.from[i];
    }
    progress_.finish(note + ", best of " + std::to_string(tried_));
    result_.made.push_back(std::move(made));
  }

  bool step() {
    std::vector<Family> families = try_all();
    const bool done = feasible(now_.smallest) ? lower_cost(families) : lower_smallest(families);
    if (!done) progress_.finish("none of " + std::to_string(tried_) + " helps");
    return done && !result_.at_limit;
  }

  bool limit_reached() {
    if (result_.made.size() < options_.most_changes) return false;
    result_.at_limit = true;
    progress_.finish("the limit of changes is reached");
    return true;
  }

  // The cut that leaves the smallest largest pair, of these the cheapest on the drives.
  bool lower_smallest(std::vector<Family>& families) {
    struct Choice {
      const Family* family;
      const Trial* trial;
    };
    std::vector<Choice> choices;
    const auto rank = [&](const Smallest& smallest) {
      return std::tuple(smallest.pair_slots, smallest.pairs);
    };
    for (const Family& family : families) {
      for (const Trial& trial : family.trials) {
        if (rank(trial.smallest) < rank(now_.smallest)) choices.push_back({&family, &trial});
      }
    }
    std::ranges::stable_sort(choices, {}, [&](const Choice& choice) {
      return std::tuple_cat(rank(choice.trial->smallest),
                            std::tuple(price(choice.trial->drives, training_)));
    });
    for (const Choice& choice : choices) {
      if (limit_reached()) return true;
      const Judgement judgement = judge(*choice.family, *choice.trial);
      Trial exact;
      std::optional<Changed> after = packed(*choice.trial, judgement, exact);
      if (!after || rank(exact.smallest) >= rank(now_.smallest)) continue;
      Family only{{exact}};  // what this very cut does, as it is not chosen by the drives
      make(std::move(*after), exact, judge(only, exact));
      return true;
    }
    return false;
  }

  bool lower_cost(std::vector<Family>& families) {
    struct Choice {
      const Family* family;
      const Trial* trial;
    };
    std::vector<Choice> choices;
    for (const Family& family : families) {
      const Trial& best = best_on(family, training_);
      if (pays(best.drives)) choices.push_back({&family, &best});
    }
    std::ranges::stable_sort(
        choices, {}, [&](const Choice& choice) { return price(choice.trial->drives, training_); });
    for (const Choice& choice : choices) {
      const Judgement judgement = judge(*choice.family, *choice.trial);
      const std::string key = key_of(choice.trial->names);
      if (!holds(judgement)) {
        rejected_[key] = step_of(*choice.trial, judgement,
                                 result_.halves ? "helps only the half that it was chosen on"
                                                : "helps only drives that it was chosen on");
        continue;
      }
      if (limit_reached()) return true;
      Trial exact;
      std::optional<Changed> after = packed(*choice.trial, judgement, exact);
      if (!after) continue;
      const bool larger =
          exact.change.kind == Change::Kind::kMerge && exact.smallest.bytes > now_.smallest.bytes;
      if (larger || !feasible(exact.smallest) || !pays(exact.drives) ||
          !holds(judge({{exact}}, exact))) {
        rejected_[key] = step_of(exact, judgement, "saves too little once it is packed");
        continue;
      }
      make(std::move(*after), exact, judgement);
      return true;
    }
    return false;
  }

  std::span<const Signature> signatures_;
  const Options& options_;
  const Weigh& weigh_;
  const Fault& fault_;
  Progress& progress_;
  const std::vector<Fold> folds_;
  std::vector<std::size_t> training_;  // tracks that the final choice is made on
  Tuned result_;
  Total now_;
  std::map<std::string, Step> rejected_;  // by the zones they would change
  std::size_t round_ = 0, tried_ = 0;
};

}  // namespace

Tuned tune(Layout layout, std::vector<Track> tracks, bool halves,
           std::span<const Signature> signatures, const Options& options, const Weigh& weigh,
           const Fault& fault, Progress& progress) {
  return Tuner(std::move(layout), std::move(tracks), halves, signatures, options, weigh, fault,
               progress)
      .run();
}

}  // namespace zonepack::packer::tune
