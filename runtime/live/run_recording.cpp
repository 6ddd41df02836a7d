// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/run_recording.hpp"

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr const char* kWithoutNames = "/var/tmp";

}  // namespace

Outcome<std::string> RunRecording::open(const RecordingChoice& choice,
                                        const RecordingPreface& preface, std::size_t zones,
                                        std::uint32_t most_frames) {
  if (!choice.file.empty()) {
    auto file = RecordingFile::create(choice.file, preface);
    if (!file) return cannot_write(choice.file, file.error());
    path_ = choice.file;
    file_ = std::move(file).value();
  }
  std::string warning;
  if (choice.flight_bytes > 0) {
    const bool named = !choice.state_folder.empty();
    const std::string folder = named ? choice.state_folder + "/flight" : kWithoutNames;
    auto flight = FlightRecorder::open(folder, named, choice.flight_bytes, preface);
    if (flight) {
      flight_ = std::move(flight).value();
    } else {
      warning = folder + ": no flight recorder: " + reason_text(flight.error()) +
                "; set state.folder to a folder that can be written, or recorder.bytes to 0";
    }
  }
  if (!file_ && !flight_) return warning;
  tap_ = std::make_unique<InputTap>(most_frames);
  writer_ = std::make_unique<InputWriter>(*tap_, preface.terms.period_ns, zones, file_.get(),
                                          flight_.get());
  writer_->learns_by(habits);
  return warning;
}

void RunRecording::on_event(const Event& event, const MapVersion& map) noexcept {
  if (!writer_) return;
  if (map.number() != map_) {
    map_ = map.number();
    writer_->change_map(map_, map.model().needs.size());
  }
  writer_->on_event(event);
}

void RunRecording::drain() {
  if (writer_) writer_->drain(monotonic_ns());
}

Outcome<void> RunRecording::finish(const std::string& event_log_hash) {
  if (!writer_) return {};
  writer_->flush();
  if (!file_) return {};
  RecordingEnd end = writer_->end();
  end.event_log_hash = event_log_hash;
  const auto not_whole = [&](const std::string& why, ErrorCode code) {
    return failure(path_ + ": the recording is not whole: " + why +
                       "; what was written before can be replayed",
                   code);
  };
  if (const auto done = file_->finish(end); !done) {
    return not_whole(reason_text(done.error()), done.error().code);
  }
  if (end.lost == 0) return {};
  return not_whole(std::to_string(end.lost) + " cycles came faster than they could be written",
                   ErrorCode::kBusy);
}

}  // namespace zonepack
