// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/flight_recorder.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "platform/files/atomic_file.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/flight_names.hpp"
#include "runtime/recording/recording_end.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCopyBytes = std::size_t{64} * 1024;

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
  if (!named) return AppendFile::create_unnamed(folder);
  // What another program put there, a link above all, is not written to.
  const std::string path = folder + "/" + name;
  std::error_code none;
  fs::remove(path, none);
  return AppendFile::create(path);
}

Result<void> copy(const AppendFile& from, std::uint64_t size, BoundedWriter& to) {
  std::vector<std::byte> buffer(kCopyBytes);
  for (std::uint64_t at = 0; at < size;) {
    const auto part = std::span(buffer).first(std::min<std::uint64_t>(kCopyBytes, size - at));
    if (const auto read = from.read_at(at, part); !read) return read;
    if (const auto written = to.write(part); !written) return written;
    at += part.size();
    if (at % AppendFile::kSettleBytes == 0) {
      drop_page_cache(to.descriptor());
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
  return broken_ || segments_.back()->file.size() >= segment_bytes_ || maps_.size() > kMostMaps;
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

// A map is needed by what follows its offer, and by segments that begin while it is in use.
bool FlightRecorder::needs(const Segment& segment, const Map& map) const noexcept {
  return map.cycle >= segment.first_cycle || map.number == segment.map;
}

void FlightRecorder::drop_unused_maps() {
  if (segments_.empty()) return;
  const Segment& oldest = *segments_.front();
  std::erase_if(maps_, [&](const std::shared_ptr<Map>& map) {
    if (needs(oldest, *map)) return false;
    std::error_code ignored;
    if (!map->path.empty()) fs::remove(map->path, ignored);
    return true;
  });
}

// The oldest segments go, with the maps that nothing else needs, until all is within its bounds.
void FlightRecorder::make_room() {
  const auto kept = [this] {
    ByteCount bytes = segment_bytes_;  // the newest, when it is full
    for (const auto& map : maps_) bytes += map->file.size();
    for (std::size_t i = 0; i + 1 < segments_.size(); ++i) {
      bytes += std::min<ByteCount>(segments_[i]->file.size(), segment_bytes_);
    }
    return bytes;
  };
  while (segments_.size() > 1 && (maps_.size() > kMostMaps || kept() > bytes_)) {
    drop_oldest();
    drop_unused_maps();
  }
}

void FlightRecorder::add_map(std::uint32_t number, ByteSpan blocks, std::uint64_t cycle) {
  const std::lock_guard lock(mutex_);
  const std::string name = flight_map_name(number);
  Result<AppendFile> file = make_file(folder_, named_, name);
  if (!file) return fail(file.error());
  auto map = std::make_shared<Map>(
      Map{std::move(file).value(), named_ ? folder_ + "/" + name : std::string(), number, cycle});
  if (const auto written = map->file.append(blocks); !written) return fail(written.error());
  map->file.settle();
  maps_.push_back(std::move(map));
  make_room();
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
              checkpoint.cycle, checkpoint.map, after_gap || (broken_ && !segments_.empty())});
  const Result<void> written = segment->file.append(block);
  segments_.push_back(std::move(segment));
  drop_unused_maps();
  make_room();
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

// The segments that follow each other without a gap up to now.
std::deque<std::shared_ptr<FlightRecorder::Segment>> FlightRecorder::whole_segments() const {
  std::deque<std::shared_ptr<Segment>> whole;
  for (auto segment = segments_.rbegin(); segment != segments_.rend(); ++segment) {
    whole.push_front(*segment);
    if ((*segment)->after_gap) break;
  }
  return whole;
}

Result<FlightRecorder::Dumped> FlightRecorder::dump(const std::string& path) const {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const std::atomic<bool> never{false};
  BoundedWriter to(file->descriptor(), never, {});
  const Result<Dumped> dumped = dump_to(to);
  if (!dumped) return dumped;
  if (const auto done = file->commit(); !done) return done.error();
  return dumped;
}

Result<FlightRecorder::Dumped> FlightRecorder::dump_to(BoundedWriter& to) const {
  Dumped dumped;
  std::vector<Part> kept;
  {
    const std::lock_guard lock(mutex_);
    const auto segments = whole_segments();
    dumped.next_cycle = next_cycle_;
    if (segments.empty() || segments.front()->first_cycle == dumped.next_cycle) {
      return ErrorCode::kNotFound;
    }
    dumped.first_cycle = segments.front()->first_cycle;
    const auto keep = [&](const auto& owner) {
      kept.push_back({std::shared_ptr<const AppendFile>(owner, &owner->file), owner->file.size()});
    };
    for (const auto& map : maps_) keep(map);
    for (const auto& segment : segments) keep(segment);
  }
  Result<void> done = copy(preface_, preface_.size(), to);
  dumped.bytes = preface_.size();
  for (const Part& part : kept) {
    if (done) done = copy(*part.file, part.size, to);
    dumped.bytes += part.size;
  }
  std::vector<std::byte> end;
  seal_block(BlockKind::kEnd, write_end({false, dumped.next_cycle, 0, {}}), end);
  dumped.bytes += end.size();
  if (done) done = to.write(end);
  if (!done) return done.error();
  return dumped;
}

ByteCount FlightRecorder::kept_bytes() const {
  const std::lock_guard lock(mutex_);
  ByteCount bytes = preface_.size();
  for (const auto& map : maps_) bytes += map->file.size();
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
