// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/recording_reader.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <utility>

#include "runtime/recording/block.hpp"
#include "runtime/recording/flight_names.hpp"

namespace zonepack {
namespace {

std::string told(const Error& error) {
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
         std::ranges::all_of(input.corrections, [](const PoseCorrection& fix) {
           return is_time(fix.stamp_ns) && is_time(fix.received_ns);
         });
}

}  // namespace

std::optional<RecordingReader> RecordingReader::open(const std::string& path, std::string& fault) {
  RecordingReader reader(path);
  if (!reader.open_files(fault) || !reader.read_start(fault)) return std::nullopt;
  return reader;
}

bool RecordingReader::open_files(std::string& fault) {
  std::vector<std::string> names = {path_};
  std::error_code error;
  if (std::filesystem::is_directory(path_, error)) names = flight_files(path_);
  for (const std::string& name : names) {
    Result<StorageFile> file = StorageFile::open(name);
    if (!file) {
      fault = name + ": cannot be read: " + told(file.error()) +
              "; expected a recording of zoned run --record or zonectl dump, or the folder of a "
              "flight recorder";
      return false;
    }
    files_.push_back(std::move(file).value());
  }
  std::array<std::byte, kRecordingHeaderBytes> header{};
  const std::size_t size = std::min<std::uint64_t>(header.size(), files_.front().size());
  const auto bytes = std::span(header).first(size);
  Result<void> checked = files_.front().read_at(0, bytes);
  if (checked) checked = check_recording_header(bytes);
  if (!checked) {
    fault = names.front() + ": not a recording that can be read: " + told(checked.error()) +
            "; expected format version " + std::to_string(kRecordingMajor);
    return false;
  }
  offset_ = kRecordingHeaderBytes;
  return true;
}

std::optional<std::uint8_t> RecordingReader::read_block(Error& error) {
  error = {};
  while (file_ < files_.size() && offset_ >= files_[file_].size()) {
    ++file_;
    offset_ = 0;
  }
  if (file_ == files_.size()) return std::nullopt;
  const auto truncated = [&] {
    error = {ErrorCode::kTruncated, static_cast<std::int64_t>(offset_)};
    return std::nullopt;
  };
  const StorageFile& file = files_[file_];
  const std::uint64_t left = file.size() - offset_;
  if (left < kBlockHeaderBytes) return truncated();
  stored_.resize(kBlockHeaderBytes);
  if (const auto read = file.read_at(offset_, stored_); !read) {
    error = read.error();
    return std::nullopt;
  }
  const Result<RecordingBlockHeader> header = read_block_header(stored_);
  if (!header) {
    error = header.error();
    return std::nullopt;
  }
  if (header->stored_size > left - kBlockHeaderBytes) return truncated();
  stored_.resize(kBlockHeaderBytes + header->stored_size);
  Result<void> done = file.read_at(offset_, stored_);
  if (done) done = open_block(stored_, block_);
  if (!done) {
    error = done.error();
    return std::nullopt;
  }
  offset_ += stored_.size();
  return header->kind;
}

bool RecordingReader::read_start(std::string& fault) {
  std::vector<std::byte> content;
  Error error;
  auto kind = read_block(error);
  while (kind == static_cast<std::uint8_t>(BlockKind::kPreface)) {
    if (content.size() + block_.size() > kMostPrefaceBytes) break;
    content.insert(content.end(), block_.begin(), block_.end());
    kind = read_block(error);
  }
  Result<RecordingPreface> preface = read_preface(content);
  if (!preface) {
    if (error.code == ErrorCode::kOk) error = preface.error();
    fault = path_ + ": its settings and map cannot be read: " + told(error) +
            "; the file is damaged, or was cut before its first cycle";
    return false;
  }
  preface_ = std::move(preface).value();
  if (preface_.start && !is_time(preface_.start->now_ns)) {
    fault = path_ + ": its start is at no time that can be; the file is damaged";
    return false;
  }
  content = {};
  for (;; kind = read_block(error)) {
    if (kind == static_cast<std::uint8_t>(BlockKind::kMap)) {
      (void)maps_.add(block_);  // one that is not whole is missing where it is needed
      continue;
    }
    if (kind != static_cast<std::uint8_t>(BlockKind::kCheckpoint)) break;
    Result<Checkpoint> checkpoint = read_checkpoint(block_);
    if (checkpoint && is_time(checkpoint->now_ns) && is_time(checkpoint->start_ns))
      checkpoint_ = std::move(checkpoint).value();
  }
  if (kind == static_cast<std::uint8_t>(BlockKind::kCycles)) {
    cycles_ = CycleBlockReader(block_);
    next_cycle_ = cycles_.next_cycle();
  } else if (kind == static_cast<std::uint8_t>(BlockKind::kEnd)) {
    if (auto end = read_end(block_)) end_ = std::move(end).value();
    stop("holds no cycle", true);
  } else {
    stop("ends before its first cycle: " + told(error));
  }
  last_ns_ = std::numeric_limits<std::int64_t>::min();
  next_cycle_first_ = next_cycle_;
  if (next_cycle_ == 0) {
    checkpoint_.reset();
  } else if (!checkpoint_ || checkpoint_->cycle != next_cycle_) {
    fault = path_ + ": begins with cycle " + std::to_string(next_cycle_) +
            " without saying how the run stood there; its beginning is missing";
    return false;
  }
  return true;
}

void RecordingReader::stop(const std::string& why, bool complete) {
  stopped_ = true;
  complete_ = complete;
  note_ = path_ + ": " + why;
}

// Makes cycles_ stand before the next cycle; false at the end.
bool RecordingReader::next_block() {
  const auto ends = [&] { return "ends after cycle " + std::to_string(next_cycle_ - 1); };
  for (;;) {
    Error error;
    const auto kind = read_block(error);
    if (!kind) {
      stop(error.code == ErrorCode::kOk || error.code == ErrorCode::kTruncated
               ? ends() + " without an end mark: the run was killed, or the file was cut"
               : ends() + ", where the file is damaged: " + told(error));
      return false;
    }
    switch (static_cast<BlockKind>(*kind)) {
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
          stop(ends() + ", where the file is damaged: " + told(end.error()));
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
        if (*kind >= kFirstNoteBlock) continue;
        stop(ends() + ": what follows (kind " + std::to_string(*kind) + ") needs a newer zoned");
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
    stop("cycle " + std::to_string(next_cycle_) + " cannot be read: " + told(read.error()));
    return nullptr;
  }
  last_ns_ = input_.now_ns;
  ++next_cycle_;
  return &input_;
}

}  // namespace zonepack
