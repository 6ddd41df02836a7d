// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/flight_recorder.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "platform/atomic_file.hpp"
#include "platform/descriptor.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/flight_names.hpp"
#include "runtime/recording/recording_end.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCopyBytes = 64 * 1024;

Error error_of(const std::error_code& code) { return {ErrorCode::kIo, code.value()}; }

void remove_flight(const std::string& folder) {
  std::error_code ignored;
  for (const std::string& file : flight_files(folder)) fs::remove(file, ignored);
  fs::remove(folder, ignored);
}

// Makes an empty folder; what another run left there is moved aside.
Result<void> make_folder(const std::string& folder) {
  std::error_code error;
  if (fs::exists(folder + "/" + kFlightPreface, error)) {
    const std::string previous = folder + "-previous";
    remove_flight(previous);
    fs::rename(folder, previous, error);
    if (error) return error_of(error);
  }
  fs::create_directories(folder, error);
  if (error) return error_of(error);
  return {};
}

Result<AppendFile> make_file(const std::string& folder, bool named, const std::string& name) {
  return named ? AppendFile::create(folder + "/" + name) : AppendFile::create_unnamed(folder);
}

Result<void> copy(const AppendFile& from, std::uint64_t size, int to) {
  std::vector<std::byte> buffer(kCopyBytes);
  for (std::uint64_t at = 0; at < size;) {
    const auto part = std::span(buffer).first(std::min<std::uint64_t>(kCopyBytes, size - at));
    if (const auto read = from.read_at(at, part); !read) return read;
    if (const auto written = write_all(to, part); !written) return written;
    at += part.size();
    if (at % AppendFile::kSettleBytes == 0) {
      drop_page_cache(to);
      from.forget();
    }
  }
  from.forget();
  return {};
}

}  // namespace

Result<std::unique_ptr<FlightRecorder>> FlightRecorder::open(const std::string& folder, bool named,
                                                             ByteCount bytes,
                                                             const RecordingPreface& preface) {
  if (named) {
    if (const auto made = make_folder(folder); !made) return made.error();
  }
  Result<AppendFile> file = make_file(folder, named, kFlightPreface);
  if (!file) return file.error();
  Result<void> written = file->append(recording_header());
  write_preface(preface, [&](ByteSpan block) {
    if (written) written = file->append(block);
  });
  if (!written) return written.error();
  file->settle();
  return std::unique_ptr<FlightRecorder>(
      new FlightRecorder(folder, named, std::max(bytes, kLeastBytes), std::move(file).value()));
}

bool FlightRecorder::wants_segment() const noexcept {
  const std::lock_guard lock(mutex_);
  return broken_ || segments_.back()->file.size() >= segment_bytes_;
}

void FlightRecorder::fail(Error error) {
  ++failures_;
  last_error_ = error;
  broken_ = true;
}

void FlightRecorder::drop_oldest() {
  const Segment& oldest = *segments_.front();
  if (!oldest.path.empty()) {
    std::error_code ignored;
    fs::remove(oldest.path, ignored);
  }
  segments_.pop_front();
}

void FlightRecorder::begin_segment(const Checkpoint& checkpoint, bool after_gap) {
  std::vector<std::byte> block;
  seal_block(BlockKind::kCheckpoint, write_checkpoint(checkpoint), block);
  const std::lock_guard lock(mutex_);
  if (!segments_.empty()) segments_.back()->file.settle();
  while (segments_.size() >= kSegments) drop_oldest();
  const std::string name = flight_segment_name(segment_number_++);
  Result<AppendFile> file = make_file(folder_, named_, name);
  if (!file) return fail(file.error());
  auto segment = std::make_shared<Segment>(
      Segment{std::move(file).value(), named_ ? folder_ + "/" + name : std::string(),
              checkpoint.cycle, after_gap || (broken_ && !segments_.empty())});
  const Result<void> written = segment->file.append(block);
  segments_.push_back(std::move(segment));
  if (!written) return fail(written.error());
  next_cycle_ = checkpoint.cycle;
  broken_ = false;
}

void FlightRecorder::append(ByteSpan block, std::uint64_t next_cycle) {
  const std::lock_guard lock(mutex_);
  if (broken_) return;
  if (const auto written = segments_.back()->file.append(block); !written) {
    return fail(written.error());
  }
  next_cycle_ = next_cycle;
}

std::deque<FlightRecorder::Part> FlightRecorder::parts() const {
  std::deque<Part> parts;
  for (auto segment = segments_.rbegin(); segment != segments_.rend(); ++segment) {
    parts.push_front({*segment, (*segment)->file.size()});
    if ((*segment)->after_gap) break;
  }
  return parts;
}

Result<FlightRecorder::Dumped> FlightRecorder::dump(const std::string& path) const {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const Result<Dumped> dumped = dump_to(file->descriptor());
  if (!dumped) return dumped;
  if (const auto done = file->commit(); !done) return done.error();
  return dumped;
}

Result<FlightRecorder::Dumped> FlightRecorder::dump_to(int fd) const {
  Dumped dumped;
  std::deque<Part> kept;
  {
    const std::lock_guard lock(mutex_);
    kept = parts();
    dumped.next_cycle = next_cycle_;
  }
  if (kept.empty() || kept.front().segment->first_cycle == dumped.next_cycle) {
    return ErrorCode::kNotFound;
  }
  dumped.first_cycle = kept.front().segment->first_cycle;
  Result<void> done = copy(preface_, preface_.size(), fd);
  dumped.bytes = preface_.size();
  for (const Part& part : kept) {
    if (done) done = copy(part.segment->file, part.size, fd);
    dumped.bytes += part.size;
  }
  std::vector<std::byte> end;
  seal_block(BlockKind::kEnd, write_end({false, dumped.next_cycle, 0, {}}), end);
  dumped.bytes += end.size();
  if (done) done = write_all(fd, end);
  if (!done) return done.error();
  return dumped;
}

ByteCount FlightRecorder::kept_bytes() const {
  const std::lock_guard lock(mutex_);
  ByteCount bytes = preface_.size();
  for (const auto& segment : segments_) bytes += segment->file.size();
  return bytes;
}

std::uint64_t FlightRecorder::failures() const {
  const std::lock_guard lock(mutex_);
  return failures_;
}

Error FlightRecorder::last_error() const {
  const std::lock_guard lock(mutex_);
  return last_error_;
}

}  // namespace zonepack
