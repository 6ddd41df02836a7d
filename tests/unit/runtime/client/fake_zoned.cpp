// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/runtime/client/fake_zoned.hpp"

#include <array>
#include <chrono>
#include <utility>

namespace zonepack::test_support {

FakeZoned::FakeZoned(const std::string& path, const SharedMemory& memory)
    : memory_(memory),
      listener_(LocalListener::listen(path, 0600).value()),
      thread_([this] { serve(); }) {}

FakeZoned::~FakeZoned() {
  done_ = true;
  thread_.join();
}

void FakeZoned::change_map(std::uint32_t serial, std::vector<std::string> names) {
  names_ = std::move(names);
  serial_ = serial;
  tell_change_ = true;
}

void FakeZoned::serve() {
  LocalSocket client;
  alignas(8) std::array<std::byte, kMostMessageBytes> buffer;
  while (!done_) {
    if (!client.is_open()) {
      auto accepted = listener_.accept();
      if (accepted) client = std::move(accepted).value();
      if (!accepted) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    if (!client.wait(false, 20)) continue;
    const auto got = client.receive(buffer);
    if (!got || got->bytes == 0) {
      client.close();
      continue;
    }
    if (const auto request = check_request(std::span(buffer).first(got->bytes))) {
      answer(client, **request);
    }
  }
}

void FakeZoned::answer(const LocalSocket& client, const wire::Request& request) {
  std::this_thread::sleep_for(std::chrono::milliseconds(answers_after_ms));
  const auto send = [&](std::span<const std::byte> bytes, std::span<const int> files = {}) {
    static_cast<void>(client.send(bytes, files));
  };
  if (tell_change_.exchange(false)) {
    MessageBuilder notice;
    send(notice.reply(0, wire::CreateMapChanged(notice.builder(), serial_, 2)));
  }
  MessageBuilder message;
  auto& builder = message.builder();
  const std::uint64_t id = request.id();
  if (fault != wire::Fault::None) return send(message.fault(id, fault, "because of the test"));
  if (request.map_serial() != 0 && request.map_serial() != serial_) {
    return send(message.fault(id, wire::Fault::StaleMap));
  }
  switch (request.body_type()) {
    case wire::RequestBody::Hello: {
      const auto file = memory_.reader_file();
      const std::vector<wire::FdKind> kinds{wire::FdKind::Memory};
      const auto descriptors = builder.CreateVector(kinds);
      const auto program = builder.CreateString("fake");
      wire::WelcomeBuilder welcome(builder);
      welcome.add_version(kProtocolVersion);
      welcome.add_program(program);
      welcome.add_map_serial(serial_);
      welcome.add_zones(2);
      welcome.add_map_epoch(epoch);
      welcome.add_descriptors(descriptors);
      const std::array files{file->get()};
      return send(message.reply(id, welcome.Finish()), files);
    }
    case wire::RequestBody::AskZones: {  // one zone a message
      const std::uint32_t first = request.body_as_AskZones()->first();
      const auto name = builder.CreateString(names_[first]);
      wire::ZoneBuilder zone(builder);
      zone.add_zone(first);
      zone.add_name(name);
      zone.add_signatures(5);
      const std::array zones{zone.Finish()};
      const auto list = builder.CreateVector(zones.data(), zones.size());
      return send(message.reply(id, wire::CreateZones(builder, first, 2, list, epoch)));
    }
    case wire::RequestBody::TakeLease: {
      const wire::Lease lease(request.body_as_TakeLease()->zone(), 7, 3);
      return send(message.reply(id, wire::CreateGranted(builder, &lease, 9'000'000)));
    }
    case wire::RequestBody::Release:
      released = request.body_as_Release()->lease()->generation();
      return send(message.reply(id, wire::CreateDone(builder)));
    case wire::RequestBody::GivePose:
      pose_stamp_ns = request.body_as_GivePose()->stamp_ns();
      return send(message.reply(id, wire::CreateDone(builder)));
    case wire::RequestBody::AskPose: {
      const wire::Pose pose(1, 2, 0.5);
      const wire::Covariance covariance(0.1, 0, 0, 0.2, 0, 0.3);
      wire::PoseReportBuilder report(builder);
      report.add_stamp_ns(42);
      report.add_pose(&pose);
      report.add_covariance(&covariance);
      report.add_valid(true);
      report.add_trusted(true);
      report.add_zone(1);
      return send(message.reply(id, report.Finish()));
    }
    case wire::RequestBody::AskNearest: {
      const std::array near{wire::Signature(1, 2, 0, 0, 17, 1, 0.25F)};
      const auto list = builder.CreateVectorOfStructs(near.data(), near.size());
      return send(message.reply(id, wire::CreateNearest(builder, true, list)));
    }
    default:
      return send(message.fault(id, wire::Fault::Unavailable));
  }
}

}  // namespace zonepack::test_support
