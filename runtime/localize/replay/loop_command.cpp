// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/loop_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <utility>

#include "platform/base/counted.hpp"
#include "platform/base/number_text.hpp"
#include "platform/can/can_log.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/process/progress.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/camera/image_file.hpp"
#include "runtime/localize/camera/image_list.hpp"
#include "runtime/localize/camera/repeat_watch.hpp"
#include "runtime/localize/check/calibration_text.hpp"
#include "runtime/localize/check/calibration_watch.hpp"
#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/query/stored_map.hpp"
#include "runtime/localize/replay/beside_run.hpp"
#include "runtime/localize/replay/camera_loop.hpp"
#include "runtime/localize/replay/fixes_file.hpp"
#include "runtime/localize/replay/loop_figures.hpp"
#include "runtime/localize/replay/loop_report.hpp"
#include "runtime/localize/replay/lost_loop.hpp"
#include "runtime/localize/replay/map_error.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/run/figures/baseline.hpp"
#include "runtime/run/figures/summary_text.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/output_check.hpp"
#include "runtime/run/run_report.hpp"

namespace zonepack::localize {
namespace {

constexpr const char* kProgram = "zoneloc replay";
const char* speaker = kProgram;  // whose messages these are

void note(const std::string& message) { std::cerr << speaker << ": " << message << '\n'; }

// Everything read before the run.
struct LoopInputs {
  RunInputs run;
  StoredMap map;
  CameraModel camera;
  std::vector<LoopImage> images;
  std::vector<BaselineRow> baseline;
  std::optional<BesideRun> beside;
};

// Fails when the list's first image is not of the calibration's size: then none is.
Outcome<void> check_size(const std::vector<ListedImage>& images, const LoopArguments& arguments,
                         const CameraModel& camera) {
  const auto image = read_image(images.front().file);
  if (!image) return {};  // refused by name when its time comes
  if (image->width == camera.width && image->height == camera.height) return {};
  return failure(images.front().file + ": is " + size_text(image->width, image->height) + ", but " +
                 arguments.calibration + " is for images of " +
                 size_text(camera.width, camera.height) + "; give the calibration of this camera");
}

Outcome<LoopInputs> read_inputs(const LoopArguments& arguments) {
  auto run = read_run_inputs(arguments);
  if (!run) return run.error();
  for (const std::string& text : run->warnings) note("warning: " + text);
  if ((run->settings.memory.payload.mask & mask_of(fb::PayloadKind::Features)) == 0) {
    return failure(arguments.config +
                   ": memory.payload leaves out features, which a camera is localized by; add "
                   "features to it");
  }
  auto camera = read_calibration(arguments.calibration);
  if (!camera) return camera.error();
  auto listed = read_image_list(arguments.images);
  if (!listed) return listed.error();
  if (const auto right = check_size(*listed, arguments, *camera); !right) return right.error();
  auto map = open_stored_map(run->catalog.folder);
  if (!map) return map.error();
  std::vector<BaselineRow> baseline;
  if (!arguments.baseline.empty()) {
    auto rows = read_baseline(arguments.baseline);
    if (!rows) return rows.error();
    baseline = std::move(*rows);
  }
  std::optional<BesideRun> beside;
  if (!arguments.beside.empty()) {
    auto other = read_beside(arguments.beside);
    if (!other) return other.error();
    beside = std::move(*other);
  }
  const LogTime time = LogTime::read(arguments.can, run->settings.can.interface);
  if (run->truth) run->truth = time.on_first_clock(*run->truth);
  if (beside) {
    for (BesideRun::Fix& fix : beside->fixes) fix.stamp_ns = time.on_first_clock(fix.stamp_ns);
  }
  std::vector<LoopImage> images;
  for (ListedImage& image : *listed) {
    images.push_back({time.on_first_clock(image.stamp_ns), image.stamp_ns, std::move(image.file)});
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const LoopImage& a, const LoopImage& b) { return a.stamp_ns < b.stamp_ns; });
  return LoopInputs{std::move(*run),   std::move(*map),     *camera,
                    std::move(images), std::move(baseline), std::move(beside)};
}

// Reads the images of the drive and looks at them. A repeated one is refused as `zoneloc run`
// refuses it.
class Camera {
 public:
  Camera(Localizer& localizer, const CameraModel& camera)
      : localizer_(localizer), camera_(camera) {}

  Outcome<QueryResult> find(const LoopImage& image, std::span<const MapFeatures* const> map,
                            const QueryPrior& prior) {
    const auto pixels = read(image);
    if (!pixels) return pixels.error();
    if (!fits(*pixels) && ++wrong_size_ <= 5) {
      note("warning: " + wrong_size(image, *pixels) + "; nothing is sent for it");
    }
    return localizer_.query(*pixels, map, prior);
  }

  // For a search.
  Outcome<ImageFeatures> describe(const LoopImage& image) {
    const auto pixels = read(image);
    if (!pixels) return pixels.error();
    if (!fits(*pixels)) return failure(wrong_size(image, *pixels));
    return *localizer_.detect(*pixels);
  }

 private:
  Outcome<GreyImage> read(const LoopImage& image) {
    auto pixels = read_image(image.file);
    if (!pixels) return pixels;
    if (repeat_.repeats(*pixels)) {
      return failure(image.file +
                     ": repeats the image before bit for bit: the camera hangs; "
                     "nothing is sent for it");
    }
    pixels->stamp_ns = image.stamp_ns;
    return pixels;
  }
  bool fits(const GreyImage& pixels) const noexcept {
    return pixels.width == camera_.width && pixels.height == camera_.height;
  }
  std::string wrong_size(const LoopImage& image, const GreyImage& pixels) const {
    return image.file + ": is " + size_text(pixels.width, pixels.height) +
           ", but the calibration is for images of " + size_text(camera_.width, camera_.height);
  }

  Localizer& localizer_;
  const CameraModel& camera_;
  RepeatWatch repeat_;
  std::size_t wrong_size_ = 0;
};

Outcome<void> write_figures(const LoopFigures& figures, const LoopArguments& arguments) {
  Failures failed;
  const bool json_on_output = arguments.json == "-";
  std::ostream& output = arguments.events == "-" ? std::cerr : std::cout;
  output << (json_on_output ? figures_json(figures) : figures_table(figures)) << std::flush;
  if (!std::cout) failed.add(failure("standard output: cannot be written", ErrorCode::kIo));
  if (!json_on_output && !arguments.json.empty()) {
    const auto written = write_file_atomically(arguments.json, figures_json(figures));
    if (!written) failed.add(cannot_write(arguments.json, written.error()));
  }
  return failed.all();
}

Outcome<void> draw(const LoopArguments& arguments, const LoopInputs& inputs,
                   const ReplayResult& result, const CameraLoop& loop, const LoopFigures& figures) {
  const RunReportInput run{inputs.run.catalog.folder, arguments.can, result.summary, result.trace,
                           inputs.baseline};
  const LoopReportInput input{.run = run,
                              .loop = loop,
                              .figures = figures,
                              .truth = inputs.run.truth ? &*inputs.run.truth : nullptr,
                              .beside = inputs.beside ? &*inputs.beside : nullptr};
  Failures failed;
  if (!arguments.report.empty()) {
    failed.add(report::write_report(arguments.report, make_loop_report(input)));
  }
  if (!arguments.picture.empty()) {
    failed.add(report::write_report(arguments.picture, make_loop_picture(input)));
  }
  return failed.all();
}

// With `lessons`, that is all it gives: nothing is written.
Outcome<void> drive(const LoopArguments& arguments, const CameraTraits& camera_is_off_by = {},
                    LoopLessons* lessons = nullptr) {
  auto inputs = read_inputs(arguments);
  if (!inputs) return inputs.error();
  inputs->camera = corrected(inputs->camera, camera_is_off_by);
  const zonepack::Settings& settings = inputs->run.settings;
  const TruthTrack* const truth = inputs->run.truth ? &*inputs->run.truth : nullptr;
  CanLogReader log(arguments.can, settings.can.interface);
  if (const auto opened = log.open(); !opened) {
    return failure(log.explain(opened.error()), opened.error().code);
  }
  LogMatch frames(log);
  Localizer localizer(inputs->camera, inputs->map.detector);
  Camera camera(localizer, inputs->camera);
  CameraLoop loop(inputs->images, std::bind_front(&Camera::find, &camera),
                  {.latency_ns = std::llround(arguments.latency_s * 1e9),
                   .descriptor_bytes = inputs->map.detector.descriptor_bytes()});
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  progress.start("localizing", inputs->images.size(), "images");
  loop.on_progress([&progress] { progress.advance(); });
  CalibrationWatch watch;
  localizer.options().keep_matches = true;
  loop.on_fix([&](const QueryResult& fix) { watch.add(inputs->camera, fix); });
  ImageMatcher matcher(localizer, inputs->map.detector);
  LostLoop lost(inputs->run.catalog, matcher, std::bind_front(&Camera::describe, &camera),
                inputs->map.detector.descriptor_bytes(),
                arguments.start.kind == StartChoice::Kind::kFix);
  loop.search_with(lost);
  HeadingWatch heading(truth);

  ReplayInput input{inputs->run.catalog, frames};
  input.truth = truth;
  input.start = arguments.start;
  input.cycle = cycle_config(settings);
  input.most_frames = settings.cycle.most_frames;
  input.terms = map_terms(arguments, inputs->run);
  input.events_path = arguments.events;
  input.fixes = &loop;
  input.observer = &heading;
  auto result = replay(std::move(input));
  progress.finish(counted(loop.views().size(), "image"));
  tell_log_faults(arguments.can, log.summary());
  if (!result) return result.error();
  const std::string mismatch =
      frames.mismatch(settings.odometry.wheels, arguments.can, log.summary());
  if (!mismatch.empty()) result->warnings.push_back(mismatch);
  for (const std::string& text : result->faults) note(text);
  for (const std::string& text : result->warnings) note("warning: " + text);
  for (const std::string& text : loop.warnings()) note("warning: " + text);
  if (loop.views().empty()) {
    return check_overlap(arguments.images, inputs->images.front().stamp_ns,
                         inputs->images.back().stamp_ns, arguments.can, frames);
  }

  if (lessons != nullptr) {
    *lessons = {loop.views().size(), std::move(watch)};
    return {};
  }
  const CalibrationReport calibration = watch.report();
  for (const CalibrationFinding& finding : calibration.findings) {
    note("warning: " + finding_text(finding, arguments.calibration) +
         "; zoneloc check prints what to paste");
  }
  constexpr double kWideSaid = 2;
  if (loop.widest() > kWideSaid) {
    note("warning: fixes were " + decimals_text(std::sqrt(loop.widest()), 1) +
         " times as far from the pose as their covariance says, and counted for less: the map is "
         "bent, the wheels slip, or the calibration is wrong (zoneloc check)");
  }
  // Read after the run, so that it does not count as the localizer's memory.
  LoopFigures figures = figures_of(loop, result->summary, heading, truth);
  figures.calibration = calibration;
  figures.lost = lost.figures();
  if (lost.searching()) figures.lost.lost_s += lost.lost_for_s(loop.end_ns());
  for (const ZoneId zone : lost.sweep().passed_over()) {
    note("warning: " +
         passed_over_text(inputs->run.catalog.zones[zone].name, "a larger --budget gives it room"));
  }
  if (truth != nullptr) {
    const auto map = MapError::read(inputs->map);
    if (!map) return map.error();
    if (!map->empty()) judge_in_map(loop, *truth, *map, figures);
  }
  Failures failed;
  failed.add(result->events_written);
  if (!arguments.fixes.empty())
    failed.add(write_fixes(arguments.fixes, loop.views(), lost.commands(), &inputs->run.catalog));
  failed.add(write_figures(figures, arguments));
  if (inputs->beside && !inputs->beside->fixes.empty()) {
    failed.add(check_overlap(arguments.beside, inputs->beside->fixes.front().stamp_ns,
                             inputs->beside->fixes.back().stamp_ns, arguments.can, frames));
  }
  failed.add(draw(arguments, *inputs, *result, loop, figures));
  failed.add(check_limits(result->summary));
  return failed.all();
}

}  // namespace

Outcome<LoopLessons> drive_for_lessons(const LoopArguments& arguments, const char* program,
                                       const CameraTraits& camera_is_off_by) {
  speaker = program;
  LoopLessons lessons;
  if (const auto driven = drive(arguments, camera_is_off_by, &lessons); !driven) {
    return driven.error();
  }
  return lessons;
}

int run_loop(const LoopArguments& arguments) {
  auto done = check_outputs({{"--events", arguments.events, true},
                             {"--json", arguments.json, true},
                             {"--fixes", arguments.fixes},
                             {"--report", arguments.report},
                             {"--picture", arguments.picture}});
  if (done) done = drive(arguments);
  return done ? 0 : report_failure(kProgram, done.error());
}

}  // namespace zonepack::localize
