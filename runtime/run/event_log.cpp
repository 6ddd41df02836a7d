// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/event_log.hpp"

#include <array>
#include <utility>

#include "platform/base/json_text.hpp"
#include "platform/base/require.hpp"
#include "runtime/pack_format/file/checksum.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kDigestBytes = 32;
constexpr std::size_t kBufferBytes = std::size_t{64} * 1024;

const unsigned char* bytes_of(const std::string& text) noexcept {
  return reinterpret_cast<const unsigned char*>(text.data());
}

}  // namespace

EventLog::EventLog(std::function<std::string_view(ZoneId)> name_of) : name_of_(std::move(name_of)) {
  ZP_REQUIRE(sodium_init() >= 0);
  crypto_generichash_init(&hash_, nullptr, 0, kDigestBytes);
}

Result<void> EventLog::write_to(const std::string& path) {
  at_once_ = path == "-";
  auto file = at_once_ ? AtomicFile::standard_output() : AtomicFile::create(path);
  if (!file) return file.error();
  file_.emplace(std::move(file).value());
  return {};
}

void EventLog::on_event(const Event& event) noexcept {
  const std::string line = line_of(event);
  crypto_generichash_update(&hash_, bytes_of(line), line.size());
  if (!file_) return;
  buffer_ += line;
  if (at_once_ || buffer_.size() >= kBufferBytes) flush();
}

void EventLog::flush() {
  const auto written = file_->write(buffer_);
  if (!written && write_error_.code == ErrorCode::kOk) write_error_ = written.error();
  buffer_.clear();
}

Result<void> EventLog::close() {
  if (file_) {
    flush();
    if (write_error_.code == ErrorCode::kOk) write_error_ = file_->commit().error();
    file_.reset();
  }
  if (write_error_.code != ErrorCode::kOk) return write_error_;
  return {};
}

std::string EventLog::hash() const {
  crypto_generichash_state so_far = hash_;
  std::array<std::uint8_t, kDigestBytes> digest{};
  crypto_generichash_final(&so_far, digest.data(), digest.size());
  return to_hex(digest);
}

std::string EventLog::line_of(const Event& event) const {
  return event_json(event, event.zone == kNoZone ? std::string_view() : name_of_(event.zone));
}

std::string event_json(const Event& event, std::string_view zone) {
  std::string line = "{\"cycle\":" + std::to_string(event.cycle);
  const auto number = [&line](const char* key, auto value) {
    line += ",\"";
    line += key;
    line += "\":";
    line += std::to_string(value);
  };
  number("t_ns", event.t_ns);
  line += ",\"event\":";
  line += json_quoted(to_string(event.kind));
  if (event.zone != kNoZone) {
    line += ",\"zone\":" + json_quoted(zone);
    number("signatures", event.signatures);
    number("bytes", event.bytes);
    number("generation", event.generation);
  }
  number("charged_signatures", event.charged_signatures);
  number("charged_bytes", event.charged_bytes);
  if (event.reason != nullptr) line += ",\"reason\":" + json_quoted(event.reason);
  if (event.has_pose) {
    number("x_mm", event.x_mm);
    number("y_mm", event.y_mm);
    number("yaw_mrad", event.yaw_mrad);
  }
  return line + "}\n";
}

}  // namespace zonepack
