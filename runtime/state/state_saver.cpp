// SPDX-License-Identifier: Apache-2.0
#include "runtime/state/state_saver.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "platform/process/clock.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kSaverTurn_ns = 50'000'000;
constexpr std::size_t kStackBytes = std::size_t{64} * 1024;
constexpr double kLessSure = 2;

}  // namespace

StateSaver::StateSaver(StateStore& store, SavedState like, std::function<StateGlimpse()> look,
                       std::function<bool(const StateGlimpse&, SavedState&)> place,
                       std::function<void(std::string)> report)
    : store_(store),
      state_(std::move(like)),
      look_(std::move(look)),
      place_(std::move(place)),
      report_(std::move(report)) {}

Result<void> StateSaver::start() {
  auto thread = Thread::start({.name = "zoned-state", .stack_bytes = kStackBytes}, true, [this] {
    while (!stop_.load()) {
      watch();
      sleep_until_ns(monotonic_ns() + kSaverTurn_ns);
    }
  });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void StateSaver::end_thread() noexcept {
  stop_.store(true);
  thread_.join();
}

void StateSaver::stop() {
  end_thread();
  const StateGlimpse glimpse = look_();
  if (glimpse.pose.valid) save(glimpse);
  save_also(true);
}

void StateSaver::watch() {
  save_also(false);
  const StateGlimpse glimpse = look_();
  if (!glimpse.pose.valid) return;
  if (tried_ && glimpse.map == map_ && glimpse.zone == zone_ &&
      glimpse.now_ns - last_ns_ < kPeriod_ns)
    return;
  save(glimpse);
}

void StateSaver::save(const StateGlimpse& glimpse) {
  if (!place_(glimpse, state_)) return;  // a newer glimpse will come
  tried_ = true;
  map_ = glimpse.map;
  zone_ = glimpse.zone;
  last_ns_ = glimpse.now_ns;
  state_.realtime_ns = realtime_ns();
  state_.T_map_base = glimpse.pose.T_map_base;
  state_.covariance = glimpse.pose.covariance;
  state_.trusted = glimpse.pose.trusted;
  const auto done = store_.save(state_);
  if (done) ++saved_;
  conclude(done);
}

void StateSaver::save_also(bool at_end) {
  if (!also_) return;
  if (const auto done = also_(at_end); !done) conclude(done);
}

void StateSaver::conclude(const Result<void>& done) {
  if (done) {
    if (std::exchange(failing_, false)) report_(store_.folder() + ": state is saved again");
    return;
  }
  ++failures_;
  if (std::exchange(failing_, true)) return;
  const bool taken = done.error().detail == EEXIST;
  report_(store_.folder() + ": state cannot be saved: " +
          (taken ? "state-0 and state-1 are not regular files"
                 : std::strerror(static_cast<int>(done.error().detail))) +
          "; after a restart the robot would not know where it is; make room there, or set "
          "state.folder to a folder that can be written");
}

RestoredStart guess_from(const SavedState& state, const PoseFilterSettings& settings) {
  return {state.T_map_base,
          std::max(settings.start_sigma_m, kLessSure * position_sigma_m(state.covariance)),
          std::max(settings.start_sigma_rad,
                   kLessSure * std::sqrt(std::max(0.0, state.covariance.yaw_yaw)))};
}

}  // namespace zonepack
