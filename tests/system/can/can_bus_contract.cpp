// SPDX-License-Identifier: Apache-2.0
// usage: ZONEPACK_CAN_INTERFACES="vcan0 can0,can1" can_bus_contract, as root: the contract of
// tests/support/can_bus_contract.hpp on interfaces of this kernel. NAME is read and written,
// NAME,OTHER read at NAME and written at OTHER, a controller on the same wire. An interface whose
// name begins with "vcan" is removed and made again. Without the variable nothing is tested, and
// that is said.
#include "tests/support/can_bus_contract.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>
#include <sstream>

#include "platform/can/socketcan.hpp"
#include "platform/files/descriptor.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kMs = 1'000'000;

void wait(std::int64_t ns) { sleep_until_ns(monotonic_ns() + ns); }

void ip(const std::string& command) {
  if (std::system(("ip link " + command).c_str()) != 0) {
    ADD_FAILURE() << "ip link " << command;
  }
}

class KernelRig final : public CanRig {
 public:
  KernelRig(std::string name, std::string other)
      : name_(std::move(name)), other_(std::move(other)) {
    if (can_remove()) {
      static_cast<void>(std::system(("ip link del " + name_ + " 2>/dev/null").c_str()));
      make_again();
    } else {
      for (const auto& end : {name_, other_}) {
        ip("set " + end + " down");
        ip("set " + end + " up type can bitrate 500000");
      }
    }
    bus_ = open(SocketCanSettings{}.receive_buffer_bytes);
    small_ = open(1024);
    ready_ = bus_ && small_ && bus_->receive({}) == 0 && small_->receive({}) == 0;
  }

  bool ready() const { return ready_; }
  CanBus& bus() override { return *bus_; }
  CanBus* small_bus() override { return small_.get(); }
  bool send(const CanFrame& frame) override;
  void settle() override { wait(60 * kMs); }
  std::int64_t now_ns() override { return monotonic_ns(); }
  void take_down() override { change("set " + name_ + " down"); }
  void bring_up() override { change("set " + name_ + " up"); }
  bool takes_fd() const override;
  bool can_inject_errors() const override { return can_remove(); }
  bool can_remove() const override { return name_.starts_with("vcan"); }
  void remove() override { change("del " + name_); }
  void make_again() override {
    ip("add " + name_ + " type vcan");
    ip("set " + name_ + " mtu 72");
    change("set " + name_ + " up");
  }

 private:
  // With the time that a bus takes to notice, and to hand its reader another socket.
  void change(const std::string& command) {
    ip(command);
    wait(300 * kMs);
  }
  std::unique_ptr<SocketCanBus> open(std::uint32_t buffer) const {
    auto bus = SocketCanBus::open(
        {.interface = name_, .ids = {kIds.begin(), kIds.end()}, .receive_buffer_bytes = buffer});
    if (!bus) ADD_FAILURE() << explain_socketcan(name_, bus.error());
    return bus ? std::move(bus).value() : nullptr;
  }

  std::string name_, other_;
  std::unique_ptr<SocketCanBus> bus_, small_;
  bool ready_ = false;
};

Descriptor sender_on(const std::string& name) {
  Descriptor can(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  const int on = 1;
  setsockopt(can.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (bind(can.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  return can;
}

bool KernelRig::send(const CanFrame& frame) {
  const Descriptor can = sender_on(other_);
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.rtr ? CAN_RTR_FLAG : 0u) |
               (frame.error ? CAN_ERR_FLAG : 0u);
  raw.len = frame.len;
  raw.flags = frame.flags;
  std::memcpy(raw.data, frame.data.data(), frame.len);
  const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
  return write(can.get(), &raw, size) == static_cast<ssize_t>(size);
}

bool KernelRig::takes_fd() const {
  ifreq request{};
  std::memcpy(request.ifr_name, name_.c_str(), name_.size());
  const Descriptor any(socket(AF_UNIX, SOCK_DGRAM, 0));
  return ioctl(any.get(), SIOCGIFMTU, &request) == 0 && request.ifr_mtu == CANFD_MTU;
}

std::vector<CanRigMaker> rigs() {
  std::vector<CanRigMaker> made;
  const char* const listed = std::getenv("ZONEPACK_CAN_INTERFACES");
  std::istringstream names(listed == nullptr ? "" : listed);
  for (std::string name; names >> name;) {
    const std::size_t comma = name.find(',');
    const std::string other = comma == std::string::npos ? name : name.substr(comma + 1);
    made.push_back([name = name.substr(0, comma), other]() -> std::unique_ptr<CanRig> {
      auto rig = std::make_unique<KernelRig>(name, other);
      if (!rig->ready()) return nullptr;
      return rig;
    });
  }
  if (made.empty()) std::cerr << "NOT TESTED: ZONEPACK_CAN_INTERFACES names no CAN interface\n";
  return made;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CanBusContract);
INSTANTIATE_TEST_SUITE_P(Kernel, CanBusContract, testing::ValuesIn(rigs()));

TEST(SocketCan, RefusesWhatIsNotThereDownOrNoCanBusByName) {
  if (rigs().empty()) GTEST_SKIP();
  const auto absent = SocketCanBus::open({.interface = "nocan0"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(SocketCanBus::open({.interface = "lo"}).error().code, ErrorCode::kBadValue);
  ip("add vcan7 type vcan");
  const auto down = SocketCanBus::open({.interface = "vcan7"});
  ASSERT_FALSE(down);
  EXPECT_NE(explain_socketcan("vcan7", down.error()).find("vcan7: is down"), std::string::npos);
  ip("del vcan7");
}

TEST(SocketCan, WaitsForAnInterfaceAndLeavesOneThatWasRenamed) {
  if (rigs().empty()) GTEST_SKIP();
  auto opened = SocketCanBus::open({.interface = "vcan8", .wait_for_interface = true});
  ASSERT_TRUE(opened);
  CanBus& bus = **opened;
  const auto read = [&bus] {
    wait(300 * kMs);
    std::array<CanFrame, 8> into;
    return bus.receive(into);
  };
  EXPECT_EQ(read(), 0u);
  EXPECT_EQ(bus.status().link, CanLink::kAbsent);
  ip("add vcan8 type vcan");
  ip("set vcan8 up");
  read();
  EXPECT_EQ(bus.status().link, CanLink::kUp);
  const can_frame sent{.can_id = 5, .len = 1, .__pad = 0, .__res0 = 0, .len8_dlc = 0, .data = {}};
  const auto send_on = [&sent](const char* name) {
    return write(sender_on(name).get(), &sent, sizeof sent) == sizeof sent;
  };
  EXPECT_TRUE(send_on("vcan8"));
  EXPECT_EQ(read(), 1u);
  ip("set vcan8 down");
  ip("set vcan8 name vcan9");
  ip("set vcan9 up");
  read();
  EXPECT_EQ(bus.status().link, CanLink::kAbsent);
  EXPECT_TRUE(send_on("vcan9"));
  EXPECT_EQ(read(), 0u);
  ip("del vcan9");
}

TEST(SocketCan, StampsAreUnharmedByAWallClockThatIsSet) {
  if (rigs().empty()) GTEST_SKIP();
  for (const std::int64_t step_s : {3600, -3600}) {
    KernelRig rig("vcan0", "vcan0");
    ASSERT_TRUE(rig.ready());
    CanFrame sent;
    sent.id = 0x123;
    const std::int64_t before_ns = rig.now_ns();
    ASSERT_TRUE(rig.send(sent));
    const std::int64_t between_ns = rig.now_ns();
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    wall.tv_sec += step_s;
    ASSERT_EQ(clock_settime(CLOCK_REALTIME, &wall), 0);
    ASSERT_TRUE(rig.send(sent));
    rig.settle();
    std::array<CanFrame, 2> got;
    ASSERT_EQ(rig.bus().receive(got), 2u);
    EXPECT_GE(got[0].stamp_ns, before_ns);
    EXPECT_LE(got[0].stamp_ns, between_ns);
    EXPECT_GE(got[1].stamp_ns, between_ns);
    EXPECT_LE(got[1].stamp_ns, rig.now_ns());
  }
}

}  // namespace
}  // namespace zonepack
