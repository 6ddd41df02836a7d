// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/run_recording.hpp"

#include <cstring>

#include "platform/clock.hpp"

namespace zonepack {
namespace {

constexpr const char* kWithoutNames = "/var/tmp";

std::string reason(const Error& error) {
  return error.code == ErrorCode::kIo ? std::strerror(static_cast<int>(error.detail))
                                      : to_string(error.code);
}

}  // namespace

bool RunRecording::open(const RecorderChoice& choice, const RecordingPreface& preface,
                        std::size_t zones, std::uint32_t most_frames, std::string& fault,
                        std::vector<std::string>& warnings) {
  if (!choice.file.empty()) {
    auto file = RecordingFile::create(choice.file, preface);
    if (!file) {
      fault = choice.file + ": cannot be written: " + reason(file.error());
      return false;
    }
    path_ = choice.file;
    file_ = std::move(file).value();
  }
  if (choice.flight_bytes > 0) {
    const bool named = !choice.state_folder.empty();
    const std::string folder = named ? choice.state_folder + "/flight" : kWithoutNames;
    auto flight = FlightRecorder::open(folder, named, choice.flight_bytes, preface);
    if (flight) {
      flight_ = std::move(flight).value();
    } else {
      warnings.push_back(folder + ": no flight recorder: " + reason(flight.error()) +
                         "; set state.folder to a folder that can be written, or recorder.bytes "
                         "to 0");
    }
  }
  if (!file_ && !flight_) return true;
  tap_ = std::make_unique<InputTap>(most_frames);
  writer_ = std::make_unique<InputWriter>(*tap_, preface.terms.period_ns, zones, file_.get(),
                                          flight_.get());
  return true;
}

void RunRecording::on_event(const Event& event) noexcept {
  if (writer_) writer_->on_event(event);
  next_.on_event(event);
}

void RunRecording::drain() {
  if (writer_) writer_->drain(monotonic_ns());
}

std::optional<std::string> RunRecording::finish(const std::string& event_log_hash) {
  if (!writer_) return std::nullopt;
  writer_->flush();
  if (!file_) return std::nullopt;
  RecordingEnd end = writer_->end();
  end.event_log_hash = event_log_hash;
  if (const auto done = file_->finish(end); !done) {
    return path_ + ": the recording is not whole: " + reason(done.error()) +
           "; what was written before can be replayed";
  }
  if (end.lost == 0) return std::nullopt;
  return path_ + ": the recording is not whole: " + std::to_string(end.lost) +
         " cycles came faster than they could be written; what was written before can be replayed";
}

}  // namespace zonepack
