// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_capture.hpp"

#include <algorithm>
#include <cerrno>
#include <string_view>

#include "platform/can/can_log_line.hpp"
#include "platform/files/output_place.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kFrames = 4096;
constexpr std::int64_t kFlush_ns = 1'000'000'000;

}  // namespace

CanCapture::CanCapture(CanBus& bus, std::string interface, std::int64_t clock_offset_ns)
    : bus_(bus),
      interface_(std::move(interface)),
      clock_offset_ns_(clock_offset_ns),
      items_(kFrames),
      line_(kCanLogLineRoom + interface_.size() + 1, '\0') {}

Result<void> CanCapture::open(const std::string& path) {
  auto opened = open_in_place(path, true);
  if (!opened) return opened.error();
  file_.reset(::fdopen(opened->get(), "wb"));
  if (!file_) return {ErrorCode::kIo, errno};
  (void)opened->release();  // the stream closes it
  return {};
}

std::size_t CanCapture::receive(std::span<CanFrame> into) noexcept {
  const std::size_t count = bus_.receive(into);
  for (const CanFrame& frame : into.first(count)) {
    not_kept_ += !items_.push({frame, bus_.dropped() + not_kept_});
  }
  return count;
}

void CanCapture::put(std::string_view text) {
  if (error_ != 0) return;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) error_ = errno;
}

void CanCapture::note_losses(std::uint64_t lost) {
  if (lost == lost_told_) return;
  put("DROPCOUNT: dropped " + std::to_string(lost - lost_told_) + " CAN frames on '" + interface_ +
      "' socket (total drops " + std::to_string(lost) + ")\n");
  lost_told_ = lost;
}

void CanCapture::write() {
  Item item;
  for (std::size_t left = items_.size(); left > 0 && items_.pop(item); --left) {
    note_losses(item.lost_before);
    item.frame.stamp_ns += clock_offset_ns_;
    const std::size_t size = write_can_log_line(item.frame, interface_, line_).size();
    line_[size] = '\n';
    put({line_.data(), size + 1});
  }
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns - flushed_ns_ < kFlush_ns || error_ != 0) return;
  if (std::fflush(file_.get()) != 0) error_ = errno;
  flushed_ns_ = now_ns;
}

Result<void> CanCapture::close() {
  write();
  if (file_ && std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) return {ErrorCode::kIo, error_};
  return {};
}

}  // namespace zonepack
