// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/camera_loop.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/localize/query/fix_slack.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

// An image may come so long before the first frame of the bus.
constexpr std::int64_t kBeforeStart_ns = 500'000'000;
constexpr std::size_t kMostWarnings = 5;

}  // namespace

QueryPrior prior_at(std::int64_t stamp_ns, const PoseEstimate& estimate) noexcept {
  const double back_s = static_cast<double>(stamp_ns - estimate.t_ns) * 1e-9;
  const double s = std::clamp(back_s, -0.5, 0.5);
  const Pose2 motion =
      along_arc(estimate.speed_m_s * s, estimate.sideways_m_s * s, estimate.yaw_rate_rad_s * s);
  return {compose(estimate.T_map_base, motion), estimate.covariance};
}

CameraLoop::CameraLoop(std::vector<LoopImage> images, ImageFinder find, const Options& options)
    : images_(std::move(images)),
      find_(std::move(find)),
      options_(options),
      features_(options.descriptor_bytes) {}

void CameraLoop::after_cycle(const FixMoment& moment, std::vector<PoseCorrection>& fixes) {
  if (!start_ns_) {
    start_ns_ = moment.now_ns;
    while (next_ < images_.size() && images_[next_].stamp_ns < moment.now_ns - kBeforeStart_ns) {
      ++next_;
    }
  }
  end_ns_ = moment.now_ns;
  if (!found_ns_ && moment.state.pose.trusted) {
    found_ns_ = moment.now_ns;
    found_after_views_ = views_.size();
  }
  if (lost_ != nullptr) lost_->follow(moment);
  while (next_ < images_.size() &&
         images_[next_].stamp_ns + options_.latency_ns / 2 <= moment.now_ns) {
    look(images_[next_++], moment, fixes);
    if (tell_) tell_();
  }
  if (lost_ != nullptr) search(moment, fixes);
}

void CameraLoop::command(const FixMoment& moment, std::vector<TimedCommand>& commands) {
  if (lost_ != nullptr) lost_->command(moment, commands);
}

void CameraLoop::refuse(LoopView& view, const std::string& why) {
  view.kind = LoopView::Kind::kUnreadable;
  if (warnings_.size() < kMostWarnings) warnings_.push_back(why);
}

// The images that the search gives a fix are among the last that were seen.
void CameraLoop::search(const FixMoment& moment, std::vector<PoseCorrection>& fixes) {
  for (const FoundFix& found : lost_->search(moment)) {
    const auto view = std::find_if(views_.rbegin(), views_.rend(), [&](const LoopView& one) {
      return one.image.stamp_ns == found.stamp_ns && one.kind == LoopView::Kind::kSearching;
    });
    if (view == views_.rend()) continue;
    view->result.accepted = view->result.found = true;
    view->result.reason = Reason::kAccepted;
    view->result.pose = found.pose;
    view->result.distinct = found.seen ? found.seen->distinct : 0;
    view->fix = {found.stamp_ns, std::max(found.stamp_ns + options_.latency_ns, moment.now_ns + 1),
                 found.pose,     found.sigma_m,
                 found.sigma_m,  found.sigma_rad};
    fixes.push_back(view->fix);
  }
}

void CameraLoop::look(const LoopImage& image, const FixMoment& moment,
                      std::vector<PoseCorrection>& fixes) {
  LoopView& view = views_.emplace_back();
  view.image = image;
  if (lost_ != nullptr && lost_->searching()) {
    const auto seen = lost_->see(image);
    view.kind = LoopView::Kind::kSearching;
    if (!seen) refuse(view, seen.error().message);
    return;
  }
  if (!moment.state.pose.valid) return;
  const QueryPrior believed = prior_at(image.stamp_ns, moment.state.pose);
  const QueryPrior prior = with_map_slack(believed);
  const auto map = features_.in_reach_of(prior, moment.resident);
  view.offered = static_cast<int>(map.size());
  auto result = find_(image, map, prior);
  if (!result) {
    refuse(view, result.error().message);
    return;
  }
  view.kind = LoopView::Kind::kQueried;
  view.result = std::move(*result);
  if (lost_ != nullptr) lost_->judge(view.result, moment);
  if (view.result.accepted && tell_fix_) tell_fix_(view.result);
  view.result.drawn = {};
  if (!view.result.accepted) return;
  if (moment.state.pose.trusted) {
    consistency_.add(mahalanobis2({believed.T_map_base, believed.covariance},
                                  {view.result.pose, view.result.covariance}));
    widest_ = std::max(widest_, consistency_.widening());
  }
  view.fix.stamp_ns = image.stamp_ns;
  view.fix.received_ns = std::max(image.stamp_ns + options_.latency_ns, moment.now_ns + 1);
  view.fix.T_map_base = view.result.pose;
  view.fix.sigma_x_m = std::sqrt(view.result.covariance.xx);
  view.fix.sigma_y_m = std::sqrt(view.result.covariance.yy);
  view.fix.sigma_yaw_rad = std::sqrt(view.result.covariance.yaw_yaw);
  view.fix.view_m = kView_m;
  fixes.push_back(view.fix);
}

}  // namespace zonepack::localize
