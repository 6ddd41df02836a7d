// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/recording_reader.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <utility>

#include "platform/base/file_kind.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/flight_names.hpp"

namespace zonepack {
namespace {

std::string error_text(const Error& error) {
  return std::string(to_string(error.code)) + " (" + std::to_string(error.detail) + ")";
}

// Times from about 36 years before the clock's zero to 146 after it: differences cannot overflow.
bool is_time(std::int64_t t_ns) noexcept {
  return t_ns >= -(std::int64_t{1} << 60) && t_ns <= std::int64_t{1} << 62;
}

bool has_sane_times(const RecordedInput& input) {
  return is_time(input.now_ns) &&
         std::ranges::all_of(input.frames,
                             [](const CanFrame& frame) { return is_time(frame.stamp_ns); }) &&
         std::ranges::all_of(input.corrections,
                             [](const PoseCorrection& fix) {
                               return is_time(fix.stamp_ns) && is_time(fix.received_ns);
                             }) &&
         std::ranges::all_of(input.edges,
                             [](const LineEdge& edge) { return is_time(edge.stamp_ns); });
}

bool is_block(const Result<std::optional<std::uint8_t>>& block, BlockKind kind) {
  return block && *block == static_cast<std::uint8_t>(kind);
}

}  // namespace

Outcome<RecordingReader> RecordingReader::open(const std::string& path) {
  RecordingReader reader(path);
  if (const auto opened = reader.open_files(); !opened) return opened.error();
  if (const auto started = reader.read_start(); !started) return started.error();
  return reader;
}

Outcome<void> RecordingReader::open_files() {
  std::vector<std::string> names = {path_};
  std::error_code error;
  if (std::filesystem::is_directory(path_, error)) names = flight_files(path_);
  for (const std::string& name : names) {
    Result<StorageFile> file = StorageFile::open(name);
    if (!file) {
      return failure(
          name + ": cannot be read: " + error_text(file.error()) +
              "; expected a recording of zoned run --record or zonectl dump, or the folder of a "
              "flight recorder",
          file.error().code);
    }
    files_.push_back(std::move(file).value());
  }
  std::array<std::byte, kRecordingHeaderBytes> header{};
  const std::size_t size = std::min<std::uint64_t>(header.size(), files_.front().size());
  const auto bytes = std::span(header).first(size);
  Result<void> checked = files_.front().read_at(0, bytes);
  if (checked) checked = check_recording_header(bytes);
  if (!checked) {
    if (const std::string kind = stand_in_at(names.front()); !kind.empty()) {
      return failure(names.front() + ": is " + kind, checked.error().code);
    }
    return failure(names.front() +
                       ": not a recording that can be read: " + error_text(checked.error()) +
                       "; expected format version " + std::to_string(kRecordingMajor),
                   checked.error().code);
  }
  offset_ = kRecordingHeaderBytes;
  return {};
}

Result<std::optional<std::uint8_t>> RecordingReader::read_block() {
  while (file_ < files_.size() && offset_ >= files_[file_].size()) {
    ++file_;
    offset_ = 0;
  }
  if (file_ == files_.size()) return std::optional<std::uint8_t>();
  const Error truncated{ErrorCode::kTruncated, static_cast<std::int64_t>(offset_)};
  const StorageFile& file = files_[file_];
  const std::uint64_t left = file.size() - offset_;
  if (left < kBlockHeaderBytes) return truncated;
  stored_.resize(kBlockHeaderBytes);
  if (const auto read = file.read_at(offset_, stored_); !read) return read.error();
  const Result<RecordingBlockHeader> header = read_block_header(stored_);
  if (!header) return header.error();
  if (header->stored_size > left - kBlockHeaderBytes) return truncated;
  stored_.resize(kBlockHeaderBytes + header->stored_size);
  Result<void> done = file.read_at(offset_, stored_);
  if (done) done = open_block(stored_, block_);
  if (!done) return done.error();
  offset_ += stored_.size();
  return std::optional(header->kind);
}

Outcome<void> RecordingReader::read_start() {
  std::vector<std::byte> content;
  auto block = read_block();
  while (is_block(block, BlockKind::kPreface)) {
    if (content.size() + block_.size() > kMostPrefaceBytes) break;
    content.insert(content.end(), block_.begin(), block_.end());
    block = read_block();
  }
  Result<RecordingPreface> preface = read_preface(content);
  if (!preface) {
    const Error error = block ? preface.error() : block.error();
    return failure(path_ + ": its settings and map cannot be read: " + error_text(error) +
                       "; the file is damaged, or was cut before its first cycle",
                   error.code);
  }
  preface_ = std::move(preface).value();
  if (preface_.start && !is_time(preface_.start->now_ns)) {
    return failure(path_ + ": its start is at no time that can be; the file is damaged");
  }
  content = {};
  for (;; block = read_block()) {
    if (is_block(block, BlockKind::kMap)) {
      (void)maps_.add(block_);  // a damaged map counts as missing, reported where it is needed
      continue;
    }
    if (!is_block(block, BlockKind::kCheckpoint)) break;
    Result<Checkpoint> checkpoint = read_checkpoint(block_);
    if (checkpoint && is_time(checkpoint->now_ns) && is_time(checkpoint->start_ns))
      checkpoint_ = std::move(checkpoint).value();
  }
  if (is_block(block, BlockKind::kCycles)) {
    cycles_ = CycleBlockReader(block_);
    next_cycle_ = cycles_.next_cycle();
  } else if (is_block(block, BlockKind::kEnd)) {
    if (auto end = read_end(block_)) end_ = std::move(end).value();
    stop("holds no cycle", true);
  } else {
    stop("ends before its first cycle: " + error_text(block.error()));
  }
  last_ns_ = std::numeric_limits<std::int64_t>::min();
  next_cycle_first_ = next_cycle_;
  if (next_cycle_ == 0) {
    checkpoint_.reset();
  } else if (!checkpoint_ || checkpoint_->cycle != next_cycle_) {
    return failure(path_ + ": begins with cycle " + std::to_string(next_cycle_) +
                   " without saying how the run stood there; its beginning is missing");
  }
  return {};
}

void RecordingReader::stop(const std::string& why, bool complete) {
  stopped_ = true;
  complete_ = complete;
  note_ = path_ + ": " + why;
}

// Positions cycles_ before the next cycle; false at the end.
bool RecordingReader::next_block() {
  const auto ends = [&] { return "ends after cycle " + std::to_string(next_cycle_ - 1); };
  for (;;) {
    const auto block = read_block();
    if (block ? !block->has_value() : block.error().code == ErrorCode::kTruncated) {
      stop(ends() + " without an end mark: the run was killed, or the file was cut");
      return false;
    }
    if (!block) {
      stop(ends() + ", where the file is damaged: " + error_text(block.error()));
      return false;
    }
    const std::uint8_t kind = **block;
    switch (static_cast<BlockKind>(kind)) {
      case BlockKind::kCycles:
        cycles_ = CycleBlockReader(block_);
        if (cycles_.next_cycle() == next_cycle_) return true;
        stop(ends() + ": the next one recorded is " + std::to_string(cycles_.next_cycle()) +
             ", those between were lost");
        return false;
      case BlockKind::kCheckpoint:
        continue;
      case BlockKind::kMap:
        (void)maps_.add(block_);
        continue;
      case BlockKind::kEnd: {
        Result<RecordingEnd> end = read_end(block_);
        if (!end) {
          stop(ends() + ", where the file is damaged: " + error_text(end.error()));
          return false;
        }
        end_ = std::move(end).value();
        if (end_->cycles != next_cycle_) {
          stop(ends() + ": " + std::to_string(end_->cycles - next_cycle_) +
               " further cycles of the run were lost");
        } else {
          stop(ends() + ", when it was saved; the run went on", true);
          if (end_->run_ended) note_.clear();
        }
        return false;
      }
      default:
        if (kind >= kFirstNoteBlock) continue;
        stop(ends() + ": what follows (kind " + std::to_string(kind) + ") needs a newer zoned");
        return false;
    }
  }
}

const RecordedInput* RecordingReader::next() {
  if (stopped_) return nullptr;
  while (cycles_.at_end()) {
    if (!next_block()) return nullptr;
  }
  Result<void> read = cycles_.next(input_);
  if (read && (input_.now_ns < last_ns_ || !has_sane_times(input_))) read = ErrorCode::kBadValue;
  if (!read) {
    stop("cycle " + std::to_string(next_cycle_) + " cannot be read: " + error_text(read.error()));
    return nullptr;
  }
  last_ns_ = input_.now_ns;
  ++next_cycle_;
  return &input_;
}

}  // namespace zonepack
