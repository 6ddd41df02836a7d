// SPDX-License-Identifier: Apache-2.0
// GPIO lines through libgpiod 1.6 and the first version of the kernel's interface; another file
// would replace this one for libgpiod 2. Nothing else includes <gpiod.h>.
#include <dirent.h>
#include <gpiod.h>
#include <linux/gpio.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <vector>

#include "platform/devices/edge_filter.hpp"
#include "platform/devices/gpio_line.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr const char* kConsumer = "zoned";
constexpr std::size_t kKernelEvents = 16;  // that wait for a line; the kernel drops later ones
constexpr std::size_t kMostLooks = 4 * kKernelEvents;  // at changes of a line, in one take()

struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

struct FoundLine {
  Chip chip;  // owns the line: closing it releases the line
  gpiod_line* line = nullptr;
};

Error last_error() noexcept {
  if (errno == EBUSY) return {ErrorCode::kBusy};
  return {ErrorCode::kIo, errno};
}

// Tries the chips one by one: libgpiod's own lookup gives up at a chip that it may not open, and
// takes the first of several chips with the same label.
Result<Chip> find_chip(const std::string& name) {
  if (name.starts_with('/')) {
    Chip chip(gpiod_chip_open(name.c_str()));
    if (chip) return chip;
    if (errno == ENOENT || errno == ENOTTY || errno == ENODEV) {
      return {ErrorCode::kNotFound, GpioPort::kNoChip};
    }
    return last_error();
  }
  std::vector<std::string> files;
  if (DIR* const folder = opendir("/dev")) {
    while (const dirent* const entry = readdir(folder)) {
      if (std::strncmp(entry->d_name, "gpiochip", 8) == 0) {
        files.push_back(std::string("/dev/") + entry->d_name);
      }
    }
    closedir(folder);
  }
  Chip found;
  int denied = 0;
  for (const std::string& file : files) {
    Chip chip(gpiod_chip_open(file.c_str()));
    if (!chip) {
      if (errno == EACCES || errno == EPERM) denied = errno;
      continue;
    }
    if (name == gpiod_chip_name(chip.get())) return chip;
    if (name != gpiod_chip_label(chip.get())) continue;
    if (found) return ErrorCode::kExists;
    found = std::move(chip);
  }
  if (found) return found;
  if (denied != 0) return {ErrorCode::kIo, denied};
  return {ErrorCode::kNotFound, GpioPort::kNoChip};
}

Result<FoundLine> find_line(const GpioLineName& name) {
  auto chip = find_chip(name.chip);
  if (!chip) return chip.error();
  FoundLine found{std::move(chip).value(), nullptr};
  unsigned number = 0;
  const char* const end = name.line.data() + name.line.size();
  const auto [rest, error] = std::from_chars(name.line.data(), end, number);
  if (error == std::errc() && rest == end) {
    if (number < gpiod_chip_num_lines(found.chip.get())) {
      found.line = gpiod_chip_get_line(found.chip.get(), number);
    }
  } else {
    found.line = gpiod_chip_find_line(found.chip.get(), name.line.c_str());
  }
  if (found.line == nullptr) return {ErrorCode::kNotFound, GpioPort::kNoLine};
  return found;
}

class Output final : public GpioOutput {
 public:
  explicit Output(FoundLine line) : line_(std::move(line)) {}
  Result<void> set(bool active) noexcept override {
    if (gpiod_line_set_value(line_.line, active) == 0) return {};
    return last_error();
  }

 private:
  FoundLine line_;
};

class Input final : public GpioInput {
 public:
  Input(FoundLine line, std::int64_t debounce_ns) : line_(std::move(line)), filter_(debounce_ns) {}

  Result<std::size_t> take(std::span<GpioEdge> into) noexcept override {
    std::size_t count = 0;
    for (std::size_t looked = 0; looked < kMostLooks && count < into.size(); ++looked) {
      const std::int64_t now_ns = monotonic_ns();  // read before the queue is found empty
      const auto raw = next();
      if (!raw) return raw.error();
      const auto edge = *raw ? filter_.change(**raw) : filter_.settle(now_ns);
      if (edge) into[count++] = *edge;
      if (!*raw) break;
    }
    return count;
  }

 private:
  // The next change of the line; nothing when all have been taken.
  Result<std::optional<GpioEdge>> next() noexcept {
    if (next_ == read_) {
      if (const auto filled = fill(); !filled) return filled.error();
    }
    if (next_ < read_) return std::optional(events_[next_++]);
    if (!look_again_) return std::optional<GpioEdge>();
    // The level of the line counts, whatever the queue lost; read before the first edge, and after
    // many edges.
    const int level = gpiod_line_get_value(line_.line);
    if (level < 0) return last_error();
    look_again_ = false;
    if ((level == 1) == filter_.level()) return std::optional<GpioEdge>();
    return std::optional(GpioEdge{monotonic_ns(), level == 1});
  }

  // Reads the kernel's events directly (linux/gpio.h). libgpiod's own call fills a timespec, which
  // is shorter in a library of 32-bit Debian than in a program built with 64-bit times.
  Result<void> fill() noexcept {
    next_ = read_ = 0;
    pollfd waiting{gpiod_line_event_get_fd(line_.line), POLLIN | POLLPRI, 0};
    const int ready = ::poll(&waiting, 1, 0);
    if (ready < 0) return last_error();
    if (ready == 0) return {};
    std::array<gpioevent_data, kKernelEvents> raw{};
    const ::ssize_t got = ::read(waiting.fd, raw.data(), sizeof raw);
    if (got < 0) return last_error();
    read_ = static_cast<std::size_t>(got) / sizeof raw[0];
    look_again_ |= read_ == raw.size();
    const std::int64_t now_ns = monotonic_ns();
    for (std::size_t i = 0; i < read_; ++i) {
      const auto stamp_ns = static_cast<std::int64_t>(raw[i].timestamp);
      // Kernels before 5.7 stamp with the wall clock, which is far ahead.
      events_[i] = {std::min(stamp_ns, now_ns), raw[i].id == GPIOEVENT_EVENT_RISING_EDGE};
    }
    return {};
  }

  FoundLine line_;
  EdgeFilter filter_;
  std::array<GpioEdge, kKernelEvents> events_{};
  std::size_t read_ = 0, next_ = 0;
  bool look_again_ = true;
};

int bias_flag(GpioBias bias) noexcept {
  switch (bias) {
    case GpioBias::kAsIs:
      return 0;
    case GpioBias::kNone:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
    case GpioBias::kPullUp:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    case GpioBias::kPullDown:
      return GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  }
  return 0;
}

class KernelGpio final : public GpioPort {
 public:
  Result<GpioLineInfo> look(const GpioLineName& name) override {
    const auto found = find_line(name);
    if (!found) return found.error();
    const auto text = [](const char* given) { return std::string(given != nullptr ? given : ""); };
    gpiod_line* const line = found->line;
    GpioLineInfo info;
    info.chip = std::string(gpiod_chip_name(found->chip.get())) + " (" +
                gpiod_chip_label(found->chip.get()) + ")";
    info.number = gpiod_line_offset(line);
    info.name = text(gpiod_line_name(line));
    if (gpiod_line_is_used(line)) {
      info.consumer = text(gpiod_line_consumer(line));
      if (info.consumer.empty()) info.consumer = "the kernel";
    }
    info.output = gpiod_line_direction(line) == GPIOD_LINE_DIRECTION_OUTPUT;
    return info;
  }

  Result<std::unique_ptr<GpioOutput>> open(const GpioOutputSettings& settings) override {
    auto found = find_line(settings.name);
    if (!found) return found.error();
    const gpiod_line_request_config request{
        kConsumer, GPIOD_LINE_REQUEST_DIRECTION_OUTPUT,
        settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0};
    if (gpiod_line_request(found->line, &request, settings.active) != 0) return last_error();
    return std::unique_ptr<GpioOutput>(std::make_unique<Output>(std::move(found).value()));
  }

  Result<std::unique_ptr<GpioInput>> open(const GpioInputSettings& settings) override {
    auto found = find_line(settings.name);
    if (!found) return found.error();
    if (gpiod_line_is_used(found->line)) return ErrorCode::kBusy;
    if (gpiod_line_direction(found->line) == GPIOD_LINE_DIRECTION_OUTPUT) {
      return ErrorCode::kMismatch;
    }
    const int low = settings.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    const gpiod_line_request_config request{kConsumer, GPIOD_LINE_REQUEST_EVENT_BOTH_EDGES,
                                            low | bias_flag(settings.bias)};
    if (gpiod_line_request(found->line, &request, 0) != 0) return last_error();
    return std::unique_ptr<GpioInput>(
        std::make_unique<Input>(std::move(found).value(), settings.debounce_ns));
  }
};

}  // namespace

GpioPort& kernel_gpio() {
  static KernelGpio port;
  return port;
}

}  // namespace zonepack
