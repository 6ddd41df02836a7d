// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/run_command.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "platform/files/write_output.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/realtime.hpp"
#include "platform/process/signals.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/check/calibration_text.hpp"
#include "runtime/localize/check/calibration_watch.hpp"
#include "runtime/localize/query/fix_slack.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/run/complaints.hpp"
#include "runtime/localize/run/fix_counters.hpp"
#include "runtime/localize/run/frame_watch.hpp"
#include "runtime/localize/run/live_search.hpp"
#include "runtime/localize/run/resident_features.hpp"
#include "runtime/localize/run/zoned_link.hpp"
#include "runtime/run/output_check.hpp"
#include "runtime/settings/socket_place.hpp"

namespace zonepack::localize {
namespace {

constexpr const char* kZoneloc = "zoneloc";
constexpr std::int64_t kTurn_ns = 50'000'000;       // how late SIGTERM is noticed
constexpr std::int64_t kReport_ns = 1'000'000'000;  // between reports to zoned
constexpr std::int64_t kReconnect_ns = 1'000'000'000;
constexpr std::int64_t kSilence_ns =
    2'000'000'000;  // of a camera, before it is said to have stopped
constexpr std::int64_t kFreshState_ns = 100'000'000;  // for the run's clock

void say(const std::string& text) { std::cerr << kZoneloc << ": " << text << std::endl; }

std::string socket_to_use(const CameraRunArguments& arguments) {
  if (!arguments.socket.empty()) return arguments.socket;
  const char* const from_environment = std::getenv("ZONED_SOCKET");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  return socket_to_ask();
}

class CameraRun {
 public:
  CameraRun(const CameraRunArguments& arguments, const CameraModel& camera)
      : arguments_(arguments),
        camera_(camera),
        socket_(socket_to_use(arguments)),
        watch_(camera.width, camera.height) {}

  Outcome<void> begin();
  Outcome<void> go();
  const FixCounters& counters() const noexcept { return counters_; }
  CalibrationReport calibration() const { return calibration_.report(); }

 private:
  Outcome<void> connect();
  void lose_zoned(const Error& error);
  void try_again();
  std::int64_t run_ns();
  std::optional<RobotState> ask_state();
  void look(const GreyImage& image);
  bool begin_search(const RobotState& state);
  void search();
  void give(const GreyImage& image, const QueryResult& result);
  void mind_calibration(const QueryResult& fix);
  void refuse(const std::string& why);
  void mind_silence(bool came);
  void report();

  const CameraRunArguments& arguments_;
  const CameraModel camera_;
  const std::string socket_;
  std::unique_ptr<ImageSource> source_;
  std::unique_ptr<ZonedLink> link_;  // null: zoned is gone
  std::unique_ptr<Localizer> localizer_;
  std::unique_ptr<ResidentFeatures> features_;
  std::unique_ptr<LiveSearch> search_;  // of the link's map; null: it has no zones to search
  std::string detector_;
  std::uint32_t epoch_ = 0;  // of the map that the detector is of
  RobotState state_;         // as zoned said it last
  FrameWatch watch_;
  CalibrationWatch calibration_;
  bool said_calibration_ = false;
  FixCounters counters_;
  Complaints complaints_{say};
  std::int64_t last_image_ns_ = 0, next_report_ns_ = 0, next_try_ns_ = 0;
  bool silent_ = false;
  bool first_fix_ = true;
};

// Connects, and makes a localizer for the features of zoned's map.
Outcome<void> CameraRun::connect() {
  auto link = ZonedLink::open(socket_);
  if (!link) return link.error();
  const std::optional<std::string> detector = link->detector();
  if (!detector) {
    return failure(socket_ + ": zoned does not say what found its map's features; update zoned",
                   ErrorCode::kBadVersion);
  }
  const auto settings = parse_detector(*detector, "zoned's map");
  if (!settings) return settings.error();
  if (!localizer_ || *detector != detector_) {
    localizer_ = std::make_unique<Localizer>(camera_, *settings);
    localizer_->options().keep_matches = true;  // for the calibration watch
    features_ = std::make_unique<ResidentFeatures>(settings->descriptor_bytes());
    detector_ = *detector;
  }
  search_.reset();
  link_ = std::make_unique<ZonedLink>(std::move(link).value());
  if (auto zones = link_->search_zones()) {
    search_ = std::make_unique<LiveSearch>(*link_, std::move(zones).value(), *localizer_, *settings,
                                           counters_, say);
  }
  epoch_ = link_->epoch();
  state_ = {};
  return {};
}

Outcome<void> CameraRun::begin() {
  if (auto connected = connect(); !connected) return connected;
  auto source = open_camera(arguments_.camera, camera_, [this] { return run_ns(); });
  if (!source) return source.error();
  source_ = std::move(source).value();
  if (!ask_state()) return failure(socket_ + ": zoned does not answer; try again");
  say(arguments_.camera_text + ", " + std::to_string(camera_.width) + "x" +
      std::to_string(camera_.height) + "; zoned at " + socket_);
  last_image_ns_ = monotonic_ns();
  return {};
}

void CameraRun::lose_zoned(const Error& error) {
  if (error.code == ErrorCode::kBusy) return;  // later
  say(socket_ + ": zoned is gone; waiting for the next");
  search_.reset();
  link_.reset();
  next_try_ns_ = monotonic_ns() + kReconnect_ns;
}

void CameraRun::try_again() {
  if (link_ && link_->epoch() != epoch_) {  // another map, perhaps another detector
    search_.reset();
    link_.reset();
  }
  const std::int64_t now_ns = monotonic_ns();
  if (link_ || now_ns < next_try_ns_) return;
  next_try_ns_ = now_ns + kReconnect_ns;
  const auto connected = connect();
  if (connected) return say(socket_ + ": connected");
  if (connected.error().code != ErrorCode::kNotFound) {
    complaints_.add("connect", connected.error().message, now_ns);
  }
}

std::optional<RobotState> CameraRun::ask_state() {
  if (!link_) return std::nullopt;
  const auto state = link_->state();
  if (!state) {
    lose_zoned(state.error());
    return std::nullopt;
  }
  state_ = *state;
  if (search_) search_->follow(state_);
  return state_;
}

// The run's clock, between zoned's answers as fast as it is said to be.
std::int64_t CameraRun::run_ns() {
  if (monotonic_ns() - state_.received_ns > kFreshState_ns) ask_state();
  const double passed_ns =
      static_cast<double>(monotonic_ns() - state_.received_ns) * arguments_.camera.speed;
  return state_.run_ns + static_cast<std::int64_t>(passed_ns);
}

void CameraRun::refuse(const std::string& why) {
  counters_.count_refused();
  // The numbers in it differ from image to image.
  std::string kind;
  for (const char c : why) {
    if (c < '0' || c > '9') kind += c;
  }
  complaints_.add(kind, why + "; nothing is sent for it", monotonic_ns());
}

void CameraRun::look(const GreyImage& image) {
  const ImageClock clock = source_->clock();
  const std::int64_t offset_ns = clock_offset_ns();
  const auto clock_now = [&] {
    const std::int64_t now_ns = monotonic_ns();
    return clock == ImageClock::kMonotonic  ? now_ns
           : clock == ImageClock::kRealtime ? now_ns + offset_ns
                                            : run_ns();
  };
  if (const std::string why = watch_.refuse(image, clock_now()); !why.empty()) return refuse(why);
  const auto state = ask_state();
  if (state && search_ && search_->searching()) {
    features_->forget();
    search_->see(image, on_run_clock(image.stamp_ns, clock, *state, offset_ns));
    return search();
  }
  if (state && !state->has_pose && begin_search(*state)) return counters_.count_without_pose();
  if (!state || !state->has_pose) {
    counters_.count_without_pose();
    if (state) {
      complaints_.add("no pose",
                      "zoned has no pose, so there is no place to look at; give one by zonectl "
                      "pose X Y YAW_DEG",
                      monotonic_ns());
    }
    return;
  }
  const QueryPrior prior =
      with_map_slack(pose_at(*state, on_run_clock(image.stamp_ns, clock, *state, offset_ns)));
  const auto map = features_->near(*link_, prior);
  const QueryResult result = localizer_->query(image, map, prior);
  if (result.accepted) {
    mind_calibration(result);
    give(image, result);
  }
  counters_.count(result, clock_now() - image.stamp_ns);
  if (!search_ || !link_) return;
  if (const auto judged = search_->judge(result, *state); !judged) lose_zoned(judged.error());
}

// False: this zoned knows no search, or there are no wheels to join views by.
bool CameraRun::begin_search(const RobotState& state) {
  if (!search_ || !state.wheels) return false;
  const auto begun = search_->begin(state);
  if (begun) return search_->searching();
  if (begun.error().code == ErrorCode::kCancelled) lose_zoned(begun.error());
  return false;
}

// A step of a search; the fixes that it ends with go to zoned.
void CameraRun::search() {
  if (!search_ || !search_->searching()) return;
  const auto state = ask_state();
  if (!state || !search_) return;
  const auto fixes = search_->step(*state);
  if (!fixes) {
    if (fixes.error().code == ErrorCode::kCancelled) lose_zoned(fixes.error());
    return;
  }
  for (const FoundFix& fix : *fixes) {
    QueryResult result;
    result.pose = fix.pose;
    result.covariance.xx = result.covariance.yy = fix.sigma_m * fix.sigma_m;
    result.covariance.yaw_yaw = fix.sigma_rad * fix.sigma_rad;
    result.inliers = fix.seen ? fix.seen->distinct : 0;
    counters_.count_found();
    if (const auto given = link_->give(result, fix.stamp_ns, ImageClock::kRun); !given) {
      counters_.count_not_taken();
      if (given.error().code == ErrorCode::kCancelled) return lose_zoned(given.error());
    }
  }
}

// Says once that something seems wrong with the calibration.
void CameraRun::mind_calibration(const QueryResult& fix) {
  constexpr std::size_t kEvery = 16;  // fixes
  calibration_.add(camera_, fix);
  if (said_calibration_ || calibration_.fixes() % kEvery != 0) return;
  for (const CalibrationFinding& finding : calibration_.report().findings) {
    say("warning: " + finding_text(finding, arguments_.calibration) +
        "; zoneloc check on a recorded drive prints what to paste");
    said_calibration_ = true;
  }
}

void CameraRun::give(const GreyImage& image, const QueryResult& result) {
  if (const auto given = link_->give(result, image.stamp_ns, source_->clock()); !given) {
    counters_.count_not_taken();
    if (given.error().code == ErrorCode::kIo || given.error().code == ErrorCode::kBadValue) {
      return complaints_.add("not taken", "zoned did not take a fix: " + reason_text(given.error()),
                             monotonic_ns());
    }
    return lose_zoned(given.error());
  }
  if (std::exchange(first_fix_, false)) {
    char text[120];
    std::snprintf(text, sizeof text, "first fix: x %.2f y %.2f m, %.1f degrees, %d inliers",
                  result.pose.x_m, result.pose.y_m, result.pose.yaw_rad * 57.29577951308232,
                  result.inliers);
    say(text);
  }
}

void CameraRun::mind_silence(bool came) {
  const std::int64_t now_ns = monotonic_ns();
  if (came) {
    last_image_ns_ = now_ns;
    if (std::exchange(silent_, false)) say(arguments_.camera_text + ": gives images again");
    return;
  }
  if (silent_ || now_ns - last_image_ns_ < kSilence_ns) return;
  silent_ = true;
  say(arguments_.camera_text + ": no image for 2 s; nothing is sent until one comes");
}

void CameraRun::report() {
  const std::int64_t now_ns = monotonic_ns();
  if (!link_ || now_ns < next_report_ns_) return;
  next_report_ns_ = now_ns + kReport_ns;
  const auto reported = link_->report(counters_, arguments_.camera_text);
  if (reported) return;
  if (reported.error().code == ErrorCode::kBadValue || reported.error().code == ErrorCode::kIo) {
    return complaints_.add("report",
                           "zoned does not take reports of a localizer: it is older, or "
                           "has four of them",
                           now_ns);
  }
  lose_zoned(reported.error());
}

Outcome<void> CameraRun::go() {
  using State = ImageSource::State;
  const std::int64_t end_ns =
      arguments_.seconds ? monotonic_ns() + static_cast<std::int64_t>(*arguments_.seconds * 1e9)
                         : INT64_MAX;
  GreyImage image;
  for (;;) {
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns >= end_ns || next_signal(now_ns) == Signal::kStop) break;
    try_again();
    const ImageSource::News news = source_->next(std::min(now_ns + kTurn_ns, end_ns), image);
    counters_.count_skipped(news.skipped);
    if (news.state == State::kDone) break;
    if (news.state == State::kBroken) return failure(news.why, ErrorCode::kIo);
    if (news.state == State::kRefused) refuse(news.why);
    if (news.state == State::kImage) look(image);
    mind_silence(news.state != State::kNothing);
    search();
    report();
  }
  next_report_ns_ = 0;
  report();
  return {};
}

}  // namespace

int run_localizer(const CameraRunArguments& arguments) {
  hold_signals();
  const auto camera = read_calibration(arguments.calibration);
  if (!camera) return report_failure(kZoneloc, camera.error());
  if (const auto possible = check_outputs({{"--json", arguments.json, true}}); !possible) {
    return report_failure(kZoneloc, possible.error());
  }
  CameraRun run(arguments, *camera);
  if (const auto begun = run.begin(); !begun) return report_failure(kZoneloc, begun.error());
  Failures all;
  all.add(run.go());
  say(run.counters().text());
  if (!arguments.json.empty()) {
    all.add(write_output(
        arguments.json, run.counters().json(process_peak_bytes(), report_json(run.calibration()))));
  }
  if (const auto done = all.all(); !done) return report_failure(kZoneloc, done.error());
  return 0;
}

}  // namespace zonepack::localize
