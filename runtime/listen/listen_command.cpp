// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/listen_command.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "platform/files/atomic_file.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/terminal.hpp"
#include "runtime/listen/listen_text.hpp"
#include "runtime/listen/listener.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/inputs/log_time.hpp"

namespace zonepack {
namespace {

constexpr const char* kListenProgram = "zoned listen";
constexpr std::int64_t kPicture_ns = 200'000'000;
constexpr std::int64_t kBlock_ns = 1'000'000'000;
constexpr int kNap_ms = 10;
constexpr std::size_t kFramesATurn = 4096;
constexpr double kOnce_s = 2;

// The true path or the fixes that go with a log, on the clock of its first frame.
Outcome<std::optional<TruthTrack>> read_reference(const ListenArguments& arguments,
                                                  const Settings& settings) {
  if (arguments.truth.empty() && arguments.corrections.empty()) {
    return std::optional<TruthTrack>();
  }
  if (arguments.feed.source.kind != CanSourceChoice::Kind::kLog) {
    return usage_failure("--truth and --corrections are on the time of a log; give --can a log");
  }
  const LogTime time = LogTime::read(arguments.feed.source.name, settings.can.interface);
  if (!arguments.truth.empty()) {
    const auto truth = read_truth(arguments.truth);
    if (!truth) return truth.error();
    return std::optional<TruthTrack>(time.on_first_clock(*truth));
  }
  auto fixes = read_corrections_as_written(arguments.corrections);
  if (!fixes) return fixes.error();
  auto track = track_of(time.on_first_clock(std::move(*fixes)));
  if (!track) {
    return failure(arguments.corrections + ": fewer than two fixes; nothing can be compared");
  }
  return track;
}

// Listening from the first frame to the end, and how it is shown meanwhile.
class ListenSession {
 public:
  ListenSession(const ListenArguments& arguments, const Settings& settings, FrameFeed& feed,
                Reference reference)
      : arguments_(arguments),
        feed_(feed),
        frames_(feed),
        listener_(settings, std::move(reference), arguments.expected),
        json_on_output_(arguments.json == "-") {
    style_.source = printable(arguments.feed.source.name);
    if (arguments.expected) style_.instruction = instruction_text(*arguments.expected);
    duration_s_ = arguments.duration_s;
    if (arguments.once && feed.paced() && !duration_s_) duration_s_ = kOnce_s;
    from_ns_ = feed.paced() ? feed.now_ns() : 0;
  }

  void listen() {
    const bool shown = feed_.paced() && !arguments_.once && !json_on_output_;
    if (shown && output_is_terminal()) {
      on_screen();
    } else {
      watch_for_end();
      in_blocks(shown);
    }
  }

  bool stopped() const noexcept { return end_was_asked() || quit_; }
  bool heard_odometry() const noexcept { return listener_.heard_odometry(); }

  std::string mismatch(const WheelOdometrySettings& wheels) const {
    const CanLogSummary* const log = feed_.log_summary();
    return frames_.mismatch(wheels, arguments_.feed.source.name, log ? *log : CanLogSummary(),
                            log ? "log" : "bus");
  }

  // Of a log that has ended as of its end, however long ago that was.
  ListenPicture last_picture() const {
    return listener_.picture(feed_.ended() ? listener_.last_ns() : feed_.now_ns(), true);
  }
  const ListenStyle& style() const noexcept { return style_; }

 private:
  // False once everything was heard. Takes what is due, at most kFramesATurn.
  bool take_frames() {
    for (std::size_t i = 0; i < kFramesATurn; ++i) {
      const auto frame = frames_.next();
      if (!frame) break;
      if (!feed_.paced() && from_ns_ == 0) from_ns_ = frame->stamp_ns;
      if (duration_s_ && static_cast<double>(frame->stamp_ns - from_ns_) * 1e-9 > *duration_s_) {
        return false;
      }
      listener_.take(*frame);
    }
    if (const auto message = feed_.message()) {
      style_.note = *message;
      if (!on_screen_) std::cerr << kListenProgram << ": " << *message << '\n';
    }
    if (feed_.ended() || end_was_asked()) return false;
    const double heard_s = static_cast<double>(feed_.now_ns() - from_ns_) * 1e-9;
    return !(feed_.paced() && duration_s_ && heard_s >= *duration_s_);
  }

  void on_screen() {
    on_screen_ = true;
    FullScreen screen;
    style_.color = true;
    std::int64_t next_ns = 0;
    while (take_frames()) {
      if (monotonic_ns() >= next_ns) {
        next_ns = monotonic_ns() + kPicture_ns;
        const TerminalSize size = terminal_size();
        screen.show(
            fitted(listen_text(listener_.picture(feed_.now_ns(), false), style_) + "\nq ends\n",
                   size.columns, size.rows));
      }
      if (screen.key(kNap_ms) == 'q') {
        quit_ = true;
        break;
      }
    }
    style_.color = false;
  }

  void in_blocks(bool shown) {
    std::int64_t next_ns = monotonic_ns() + kBlock_ns;
    while (take_frames()) {
      if (!feed_.paced()) continue;
      if (monotonic_ns() >= next_ns) {
        next_ns += kBlock_ns;
        if (shown) {
          std::cout << listen_text(listener_.picture(feed_.now_ns(), false), style_) << std::endl;
        }
      }
      sleep_until_ns(monotonic_ns() + std::int64_t{kNap_ms} * 1'000'000);
    }
  }

  const ListenArguments& arguments_;
  FrameFeed& feed_;
  LogMatch frames_;
  Listener listener_;
  ListenStyle style_;
  bool json_on_output_;
  bool on_screen_ = false, quit_ = false;
  std::optional<double> duration_s_;
  std::int64_t from_ns_ = 0;
};

Outcome<void> write_json(const std::string& path, const std::string& json) {
  if (path.empty()) return {};
  if (path == "-") {
    std::cout << json << std::flush;
    return {};
  }
  if (const auto written = write_file_atomically(path, json); !written) {
    return cannot_write(path, written.error());
  }
  return {};
}

Outcome<void> listen_and_report(const ListenArguments& arguments) {
  const auto loaded = load_usable_settings(arguments.config);
  if (!loaded) return loaded.error();
  for (const std::string& text : loaded->warnings) {
    std::cerr << kListenProgram << ": warning: " << text << '\n';
  }
  const Settings& settings = loaded->settings;
  const auto track = read_reference(arguments, settings);
  if (!track) return track.error();
  Reference reference;
  if (*track) {
    reference = {motion_on(**track),
                 arguments.truth.empty() ? "the localizer's fixes" : "the true path"};
  }
  auto feed = FrameFeed::open(arguments.feed, settings);
  if (!feed) return feed.error();
  const auto session =
      std::make_unique<ListenSession>(arguments, settings, **feed, std::move(reference));
  session->listen();

  if (const CanLogSummary* const log = (*feed)->log_summary()) {
    tell_log_faults(arguments.feed.source.name, *log);
  }
  const ListenPicture picture = session->last_picture();
  const std::string mismatch = session->mismatch(settings.odometry.wheels);
  (arguments.json == "-" ? std::cerr : std::cout)
      << listen_text(picture, session->style()) << std::flush;
  Failures failed;
  failed.add(
      write_json(arguments.json, listen_json(picture, arguments.feed.source.name, mismatch)));
  if (!std::cout) failed.add(failure("standard output: cannot be written", ErrorCode::kIo));
  if (!session->heard_odometry() && !session->stopped()) {
    failed.add(failure(mismatch.empty() ? "no signal of odometry could be read" : mismatch));
  } else if (!mismatch.empty()) {
    std::cerr << kListenProgram << ": " << mismatch << '\n';
  }
  if (arguments.expected && !picture.hints.empty()) {
    failed.add(failure("the robot did not move as expected (" +
                       instruction_text(*arguments.expected) + "): see the hints"));
  }
  return failed.all();
}

}  // namespace

int run_listen(const ListenArguments& arguments) {
  const auto done = listen_and_report(arguments);
  return done ? 0 : report_failure(kListenProgram, done.error());
}

}  // namespace zonepack
