// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_gpio.hpp"

#include <algorithm>
#include <cerrno>

#include "platform/base/require.hpp"

namespace zonepack {

using Locked = std::lock_guard<std::mutex>;

class SimGpio::Output final : public GpioOutput {
 public:
  Output(SimGpio& gpio, const Place& place, bool active_low)
      : gpio_(gpio), wire_(*place.wire), line_(*place.line), active_low_(active_low) {}
  ~Output() override {
    const Locked guard(gpio_.mutex_);
    line_.consumer.clear();
  }

  Result<void> set(bool active) noexcept override {
    std::unique_lock lock(gpio_.mutex_);
    ++gpio_.hanging_;
    gpio_.moved_.wait(lock, [this] { return !wire_.hangs; });
    --gpio_.hanging_;
    if (wire_.gone) return {ErrorCode::kIo, ENODEV};
    const bool high = active != active_low_;
    line_.changes += high != line_.high;
    line_.high = high;
    return {};
  }

 private:
  SimGpio& gpio_;
  Wire& wire_;
  Line& line_;
  bool active_low_;
};

class SimGpio::Input final : public GpioInput {
 public:
  Input(SimGpio& gpio, const Place& place, const GpioInputSettings& settings)
      : gpio_(gpio),
        wire_(*place.wire),
        line_(*place.line),
        active_low_(settings.active_low),
        filter_(settings.debounce_ns) {}
  ~Input() override {
    const Locked guard(gpio_.mutex_);
    line_.consumer.clear();
    line_.watched = false;
    line_.edges.clear();
  }

  Result<std::size_t> take(std::span<GpioEdge> into) noexcept override {
    const Locked guard(gpio_.mutex_);
    if (wire_.gone) return {ErrorCode::kIo, ENODEV};
    look_again_ |= line_.edges.size() == kQueue;
    std::size_t count = 0;
    while (count < into.size()) {
      std::optional<GpioEdge> edge;
      if (!line_.edges.empty()) {
        const GpioEdge raw = line_.edges.front();
        line_.edges.pop_front();
        edge = filter_.change({raw.stamp_ns, raw.active != active_low_});
        if (edge) into[count++] = *edge;
        continue;
      }
      if (look_again_) {
        edge = filter_.change({gpio_.now_ns_, line_.high != active_low_});
        look_again_ = false;
      } else {
        edge = filter_.settle(gpio_.now_ns_);
      }
      if (!edge) break;
      into[count++] = *edge;
    }
    return count;
  }

 private:
  SimGpio& gpio_;
  Wire& wire_;
  Line& line_;
  bool active_low_;
  bool look_again_ = true;
  EdgeFilter filter_;
};

void SimGpio::add_chip(const std::string& label, unsigned lines) {
  const Locked guard(mutex_);
  auto made = std::make_unique<Wire>();
  made->name = "gpiochip" + std::to_string(wires_.size());
  made->label = label;
  made->lines.resize(lines);
  wires_.push_back(std::move(made));
}

SimGpio::Wire* SimGpio::wire(const std::string& label) const {
  const auto found = std::find_if(wires_.begin(), wires_.end(),
                                  [&](const auto& one) { return one->label == label; });
  ZP_REQUIRE(found != wires_.end());
  return found->get();
}

SimGpio::Line& SimGpio::line(const std::string& label, unsigned number) const {
  return wire(label)->lines.at(number);
}

void SimGpio::name_line(const std::string& label, unsigned number, const std::string& name) {
  const Locked guard(mutex_);
  line(label, number).name = name;
}

void SimGpio::remove_chip(const std::string& label) {
  const Locked guard(mutex_);
  wire(label)->gone = true;
}

void SimGpio::advance_to(std::int64_t now_ns) {
  const Locked guard(mutex_);
  now_ns_ = std::max(now_ns_, now_ns);
}

std::int64_t SimGpio::now_ns() const {
  const Locked guard(mutex_);
  return now_ns_;
}

void SimGpio::drive(const std::string& label, unsigned number, bool high) {
  const Locked guard(mutex_);
  Line& model = line(label, number);
  if (model.high == high) return;
  model.high = high;
  if (model.watched && model.edges.size() < kQueue) model.edges.push_back({now_ns_, high});
}

bool SimGpio::is_high(const std::string& label, unsigned number) const {
  const Locked guard(mutex_);
  return line(label, number).high;
}

std::uint64_t SimGpio::changes(const std::string& label, unsigned number) const {
  const Locked guard(mutex_);
  return line(label, number).changes;
}

void SimGpio::occupy(const std::string& label, unsigned number, const std::string& consumer) {
  const Locked guard(mutex_);
  line(label, number).consumer = consumer;
}

void SimGpio::release(const std::string& label, unsigned number) { occupy(label, number, ""); }

void SimGpio::make_output(const std::string& label, unsigned number) {
  const Locked guard(mutex_);
  line(label, number).output = true;
}

void SimGpio::hang(const std::string& label, bool hangs) {
  const Locked guard(mutex_);
  wire(label)->hangs = hangs;
  moved_.notify_all();
}

int SimGpio::hanging() const {
  const Locked guard(mutex_);
  return hanging_;
}

Result<SimGpio::Place> SimGpio::find(const GpioLineName& name) {
  Wire* chip = nullptr;
  for (const auto& one : wires_) {
    if (one->gone) continue;
    if (name.chip == one->name || name.chip == "/dev/" + one->name) {
      chip = one.get();
      break;
    }
    if (name.chip != one->label) continue;
    if (chip != nullptr) return ErrorCode::kExists;
    chip = one.get();
  }
  if (chip == nullptr) return {ErrorCode::kNotFound, kNoChip};
  for (unsigned i = 0; i < chip->lines.size(); ++i) {
    Line& line = chip->lines[i];
    if (name.line == std::to_string(i) || (!line.name.empty() && name.line == line.name)) {
      return Place{chip, &line, i};
    }
  }
  return {ErrorCode::kNotFound, kNoLine};
}

Result<GpioLineInfo> SimGpio::look(const GpioLineName& name) {
  const Locked guard(mutex_);
  const auto place = find(name);
  if (!place) return place.error();
  return GpioLineInfo{place->wire->name + " (" + place->wire->label + ")", place->number,
                      place->line->name, place->line->consumer, place->line->output};
}

Result<std::unique_ptr<GpioOutput>> SimGpio::open(const GpioOutputSettings& settings) {
  const Locked guard(mutex_);
  const auto place = find(settings.name);
  if (!place) return place.error();
  if (!place->line->consumer.empty()) return ErrorCode::kBusy;
  place->line->consumer = "zoned";
  place->line->output = true;
  place->line->high = settings.active != settings.active_low;
  return std::unique_ptr<GpioOutput>(std::make_unique<Output>(*this, *place, settings.active_low));
}

Result<std::unique_ptr<GpioInput>> SimGpio::open(const GpioInputSettings& settings) {
  const Locked guard(mutex_);
  const auto place = find(settings.name);
  if (!place) return place.error();
  if (!place->line->consumer.empty()) return ErrorCode::kBusy;
  if (place->line->output) return ErrorCode::kMismatch;
  place->line->consumer = "zoned";
  place->line->watched = true;
  // When nothing outside drives the line, the pull decides.
  if (settings.bias == GpioBias::kPullUp) place->line->high = true;
  return std::unique_ptr<GpioInput>(std::make_unique<Input>(*this, *place, settings));
}

}  // namespace zonepack
