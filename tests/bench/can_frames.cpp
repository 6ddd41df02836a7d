// SPDX-License-Identifier: Apache-2.0
// usage: can_frames [INTERFACE]: what taking frames costs a control thread that runs at 1 kHz on
// one processor: receive() and odometry, for a number of frames per cycle. Prints time per cycle
// and per frame, and the most frames per second whose cycles end within their millisecond (99 of
// 100) without loss. Without INTERFACE from the simulated bus. With it, which must be a vcan that
// is up, from the kernel, with stamps and filters as zoned sets them, next to `candump -L INTERFACE
// >/dev/null`, measured by its processor time for the same frames.
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "platform/can/socketcan.hpp"
#include "platform/files/descriptor.hpp"
#include "platform/process/clock.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kCycles = 400;
constexpr std::int64_t kPeriod_ns = 1'000'000;

WheelOdometrySettings agilex() {
  WheelOdometrySettings odometry;
  CanSignal signal;
  signal.id = 0x311;
  signal.type = SignalType::kSigned;
  signal.factor = 0.001;
  odometry.signals = {signal, signal, {}, {}};
  odometry.signals[0].bits = {7, 32, ByteOrder::kBig};
  odometry.signals[1].bits = {39, 32, ByteOrder::kBig};
  return odometry;
}

std::int64_t percentile(std::vector<std::int64_t>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// `supply` makes frames arrive; only taking them is timed.
void measure(CanBus& bus, const std::function<void(std::size_t)>& supply) {
  std::printf("%8s %12s %12s %14s %14s\n", "frames", "cycle p50 us", "cycle p99 us", "frame p50 ns",
              "frame p99 ns");
  std::size_t most = 0;
  WheelOdometry odometry(agilex());
  for (const std::size_t frames :
       {1u, 8u, 16u, 32u, 64u, 128u, 256u, 512u, 1024u, 2048u, 4096u, 8192u}) {
    std::vector<CanFrame> into(frames);
    std::vector<std::int64_t> took;
    const std::uint64_t dropped = bus.dropped();
    std::size_t taken = 0;
    for (std::size_t cycle = 0; cycle < kCycles; ++cycle) {
      supply(frames);
      const std::int64_t began_ns = monotonic_ns();
      const std::size_t count = bus.receive(into);
      for (std::size_t i = 0; i < count; ++i) odometry.take(into[i]);
      took.push_back(monotonic_ns() - began_ns);
      taken += count;
    }
    std::sort(took.begin(), took.end());
    const std::int64_t p50 = percentile(took, 0.5), p99 = percentile(took, 0.99);
    const auto each = static_cast<std::int64_t>(frames);
    std::printf("%8zu %12.1f %12.1f %14lld %14lld\n", frames, static_cast<double>(p50) / 1000,
                static_cast<double>(p99) / 1000, static_cast<long long>(p50 / each),
                static_cast<long long>(p99 / each));
    if (taken != frames * kCycles || bus.dropped() != dropped) {
      std::printf("%zu of %zu taken, %llu lost\n", taken, frames * kCycles,
                  static_cast<unsigned long long>(bus.dropped() - dropped));
      break;
    }
    if (p99 > kPeriod_ns) break;
    most = frames;
  }
  std::printf("at 1 kHz without loss: at least %zu frames/s\n", most * 1000);
}

void simulated() {
  SimCanBus bus;
  std::int64_t now_ns = 0;
  measure(bus, [&](std::size_t frames) {
    CanFrame frame;
    frame.id = 0x311;
    frame.len = 8;
    for (std::size_t i = 0; i < frames; ++i) {
      frame.stamp_ns = ++now_ns * 1000;
      bus.push(frame);
    }
    bus.advance_to(now_ns * 1000);
  });
}

class Sender {
 public:
  explicit Sender(const char* interface) : can_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex(interface));
    good_ = bind(can_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  bool good() const { return good_; }
  void send(std::size_t frames) const {
    can_frame frame{};
    frame.can_id = 0x311;
    frame.len = 8;
    for (std::size_t i = 0; i < frames; ++i) {
      while (write(can_.get(), &frame, sizeof frame) != sizeof frame) {
        sleep_until_ns(monotonic_ns() + kPeriod_ns);
      }
    }
  }

 private:
  Descriptor can_;
  bool good_ = false;
};

double seconds_of(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void candump(const char* interface, const Sender& sender) {
  constexpr std::size_t kBursts = 400, kBurst = 50;
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    execlp("candump", "candump", "-L", interface, static_cast<char*>(nullptr));
    _exit(127);
  }
  sleep_until_ns(monotonic_ns() + 300 * kPeriod_ns);
  for (std::size_t i = 0; i < kBursts; ++i) {
    sender.send(kBurst);
    sleep_until_ns(monotonic_ns() + 20 * kPeriod_ns);  // candump's turn
  }
  kill(child, SIGTERM);
  rusage usage{};
  int status = 0;
  wait4(child, &status, 0, &usage);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    std::printf("candump is not installed\n");
    return;
  }
  const double each_s = seconds_of(usage) / static_cast<double>(kBursts * kBurst);
  std::printf("candump: %.0f ns of processor time per frame, %.0f frames/s\n", each_s * 1e9,
              1 / each_s);
}

int on_interface(const char* interface) {
  SocketCanSettings settings;
  settings.interface = interface;
  settings.ids = {{0x311, false}};
  auto bus = SocketCanBus::open(settings);
  if (!bus) {
    std::fprintf(stderr, "%s\n", explain_socketcan(interface, bus.error()).c_str());
    return 1;
  }
  const Sender sender(interface);
  if (!sender.good()) return 1;
  (*bus)->receive({});
  measure(**bus, [&](std::size_t frames) { sender.send(frames); });
  (*bus).reset();  // closes the socket, so that candump is the only reader
  candump(interface, sender);
  return 0;
}

}  // namespace
}  // namespace zonepack

int main(int argc, char** argv) {
  if (argc > 1) return zonepack::on_interface(argv[1]);
  zonepack::simulated();
  return 0;
}
