// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "platform/base/file_kind.hpp"
#include "platform/base/shell_word.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kStray_ns = 3600LL * 1'000'000'000;
constexpr std::size_t kExcerpt = 60;

}  // namespace

CanLogReader::CanLogReader(std::string path, std::string interface)
    : path_(std::move(path)), interface_(std::move(interface)) {}

CanLogReader::~CanLogReader() = default;

Result<void> CanLogReader::start() {
  summary_ = {};
  summary_.interface = interface_;
  end_ = false;
  relative_ = false;
  given_ = false;
  added_ns_ = 0;
  rhythm_count_ = 0;
  asc_lines_ = {};
  piece_ = {};
  file_.reset();
  Result<ReadStream> file = ReadStream::open(path_);
  if (!file) return file.error();
  file_.emplace(std::move(*file));
  refill();
  return {};
}

Result<void> CanLogReader::open() {
  if (const auto started = start(); !started) return started;
  if (count_ == 0 && !other_.empty() && !several_others_) {
    interface_ = other_;
    if (const auto again = start(); !again) return again;
  }
  if (count_ == 0 && summary_.read_error != 0) return {ErrorCode::kIo, summary_.read_error};
  if (count_ == 0) return {ErrorCode::kBadStructure, static_cast<std::int64_t>(summary_.lines)};
  if (relative_ && stamps_are_differences()) return ErrorCode::kBadValue;
  return {};
}

std::string CanLogReader::explain(const Error& error) const {
  switch (error.code) {
    case ErrorCode::kNotFound:
      return path_ + ": no such file; expected a candump log" +
             (path_.starts_with("log:") ? ", its name without log:" : "");
    case ErrorCode::kIo:
      return path_ + ": cannot be read: " + std::strerror(static_cast<int>(error.detail));
    case ErrorCode::kBadValue:
      return path_ +
             ": the stamps are time differences (candump -td); record with candump -l, -L, -ta or "
             "-tz";
    default:
      break;
  }
  if (foreign_ != nullptr) {
    std::string kind = foreign_;
    const std::size_t at = kind.find("FILE");
    return path_ + ": is " + kind.replace(at, 4, shell_quoted(path_));
  }
  if (const std::string kind = stand_in_at(path_); !kind.empty()) {
    return path_ + ": is " + kind +
           "; expected lines such as (1718021600.001102) can0 311#000040DB00015BCF";
  }
  std::string message =
      path_ + ": no CAN frame in " + std::to_string(summary_.lines) +
      " lines; expected lines such as (1718021600.001102) can0 311#000040DB00015BCF";
  if (summary_.other_interfaces > 0) {
    message += "; " + std::to_string(summary_.other_interfaces) +
               " frames are of other interfaces than " + interface_ + ": " + summary_.other_names +
               "; say which one by can.interface";
  }
  if (!summary_.faults.empty()) {
    message += "; line " + std::to_string(summary_.faults.front().line) + ": " +
               summary_.faults.front().what;
  }
  return message;
}

void CanLogReader::name_other(std::string_view name) {
  constexpr std::size_t kMost = 100;  // characters of all names
  const std::string listed = ", " + summary_.other_names + ",";
  const std::string wanted = ", " + std::string(name) + ",";
  if (summary_.other_names.size() > kMost || listed.find(wanted) != std::string::npos) return;
  summary_.other_names += (summary_.other_names.empty() ? "" : ", ") + std::string(name);
}

void CanLogReader::note(std::uint64_t line, std::string_view what, std::string_view text) {
  if (summary_.faults.size() == kMostFaults) return;
  std::string message(what);
  message += ": \"";
  for (const char c : text.substr(0, kExcerpt)) message += c >= ' ' && c <= '~' ? c : '?';
  message += text.size() > kExcerpt ? "...\"" : "\"";
  summary_.faults.push_back({line, std::move(message)});
}

// -1 at the end of the file, or where it cannot be read any further.
int CanLogReader::read_byte() {
  if (piece_.empty()) {
    const Result<std::span<const char>> next = file_->next();
    if (!next) summary_.read_error = static_cast<int>(next.error().detail);
    if (!next || next->empty()) return -1;
    piece_ = *next;
  }
  const char byte = piece_.front();
  piece_ = piece_.subspan(1);
  return static_cast<unsigned char>(byte);
}

// False at the end of the file. A line longer than the buffer is cut, which makes it a broken line.
bool CanLogReader::read_line(std::string_view& line) {
  std::size_t size = 0;
  int c = 0;
  while ((c = read_byte()) >= 0 && c != '\n') {
    if (size < line_.size()) line_[size++] = static_cast<char>(c);
  }
  if (c < 0 && size == 0) return false;
  line = {line_.data(), size};
  ++summary_.lines;
  return true;
}

std::optional<CanLogReader::Item> CanLogReader::read_frame() {
  std::string_view text;
  while (read_line(text)) {
    if (summary_.lines == 1) {
      asc_ = CanAscLines::begins_with(text);
      foreign_ = foreign_can_log(text);
    }
    CanLogLine line = asc_ ? asc_lines_.parse(text) : parse_can_log_line(text);
    if (text.size() == kLongestLine) {
      line.kind = CanLogLine::Kind::kBroken;
      line.fault = "line of over 1000 characters";
    }
    if (line.kind == CanLogLine::Kind::kDrop) summary_.dropped += line.dropped;
    if (line.kind == CanLogLine::Kind::kBroken) {
      ++summary_.broken_lines;
      note(summary_.lines, line.fault, text);
    }
    if (line.kind != CanLogLine::Kind::kFrame) continue;
    if (!interface_.empty() && line.interface != interface_) {
      ++summary_.other_interfaces;
      name_other(line.interface);
      if (other_.empty()) other_ = line.interface;
      several_others_ = several_others_ || line.interface != other_;
      continue;
    }
    relative_ = relative_ || !line.absolute_stamp;
    return Item{line.frame, summary_.dropped, summary_.lines};
  }
  return std::nullopt;
}

void CanLogReader::refill() {
  while (!end_ && count_ < kAhead) {
    const std::optional<Item> item = read_frame();
    end_ = !item;
    if (item) ahead_[(first_ + count_++) % kAhead] = *item;
  }
}

// candump -tz counts up from zero; -td jumps up and down unless frames come at even intervals.
bool CanLogReader::stamps_are_differences() const noexcept {
  std::size_t back = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    if (ahead_[i].frame.stamp_ns < ahead_[i - 1].frame.stamp_ns) ++back;
  }
  return count_ >= 8 && back * 5 >= count_;
}

bool CanLogReader::is_stray(const Item& item) const noexcept {
  if (count_ < 2 || (given_ && item.frame.stamp_ns - latest_ns_ <= kStray_ns)) return false;
  return item.frame.stamp_ns - ahead_[(first_ + 1) % kAhead].frame.stamp_ns > kStray_ns;
}

// Of a step back, the frame behind this one must know too: a single early stamp is disorder.
bool CanLogReader::clock_was_set_before(const Item& item) const noexcept {
  if (!given_) return false;
  if (item.frame.stamp_ns - latest_ns_ > kLongestSilence_ns) return true;
  const auto early = [this](const Item& one) {
    return latest_ns_ - one.frame.stamp_ns > kMostDisorder_ns;
  };
  return early(item) && count_ > 1 && early(ahead_[(first_ + 1) % kAhead]);
}

// Makes the frame come one period after the last of its id, and not before any other.
void CanLogReader::bridge(const Item& item) noexcept {
  ++summary_.clock_steps;
  if (summary_.steps.size() < kMostFaults) {
    summary_.steps.push_back({item.line, latest_ns_, item.frame.stamp_ns});
  }
  std::int64_t arrival_ns = latest_ns_ + added_ns_;
  const CanId id{item.frame.id, item.frame.extended};
  for (const Rhythm& rhythm : std::span(rhythms_).first(rhythm_count_)) {
    if (rhythm.id == id) arrival_ns = std::max(arrival_ns, rhythm.last_ns + rhythm.period_ns);
  }
  added_ns_ = arrival_ns - item.frame.stamp_ns;
  latest_ns_ = item.frame.stamp_ns;
}

void CanLogReader::note_arrival(const CanFrame& frame) noexcept {
  const CanId id{frame.id, frame.extended};
  const auto known = std::span(rhythms_).first(rhythm_count_);
  const auto found = std::ranges::find(known, id, &Rhythm::id);
  if (found != known.end()) {
    found->period_ns = std::max<std::int64_t>(0, frame.stamp_ns - found->last_ns);
    found->last_ns = frame.stamp_ns;
  } else if (rhythm_count_ < kMostRhythms) {
    rhythms_[rhythm_count_++] = {id, frame.stamp_ns, 0};
  }
}

std::optional<CanFrame> CanLogReader::next() noexcept {
  while (count_ > 0) {
    Item item = ahead_[first_];
    const bool stray = is_stray(item);
    if (!stray && clock_was_set_before(item)) bridge(item);
    first_ = (first_ + 1) % kAhead;
    --count_;
    if (count_ < 2) refill();
    if (stray) {
      ++summary_.stray_stamps;
      note(item.line, "stamp over an hour after both neighbours", "");
      continue;
    }
    if (given_ && item.frame.stamp_ns < latest_ns_) ++summary_.unsorted_stamps;
    latest_ns_ = given_ ? std::max(latest_ns_, item.frame.stamp_ns) : item.frame.stamp_ns;
    given_ = true;
    dropped_before_ = item.dropped;
    ++summary_.frames;
    if (item.frame.error) ++summary_.error_frames;
    item.frame.stamp_ns += added_ns_;
    note_arrival(item.frame);
    return item.frame;
  }
  return std::nullopt;
}

}  // namespace zonepack
