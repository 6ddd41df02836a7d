// SPDX-License-Identifier: Apache-2.0
#include "runtime/protocol/messages.hpp"

#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

constexpr char kRequestMark[] = "ZPQ1";
constexpr char kReplyMark[] = "ZPA1";
constexpr flatbuffers::uoffset_t kDepth = 6;
constexpr flatbuffers::uoffset_t kTables = 1024;

template <typename Root>
Result<const Root*> check(std::span<const std::byte> bytes, const char* mark) noexcept {
  if (bytes.size() > kMostMessageBytes) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(bytes.size())};
  }
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(),
                                 kDepth, kTables);
  if (!verifier.VerifyBuffer<Root>(mark)) return ErrorCode::kBadStructure;
  return flatbuffers::GetRoot<Root>(bytes.data());
}

}  // namespace

Result<const wire::Request*> check_request(std::span<const std::byte> bytes) noexcept {
  return check<wire::Request>(bytes, kRequestMark);
}

Result<const wire::Reply*> check_reply(std::span<const std::byte> bytes) noexcept {
  const auto reply = check<wire::Reply>(bytes, kReplyMark);
  if (!reply) return reply;
  const wire::Route* const route = (*reply)->body_as_Route();
  if (route != nullptr && !is_aligned(route->doors())) return ErrorCode::kBadStructure;
  return reply;
}

std::span<const std::byte> MessageBuilder::fault(std::uint64_t id, wire::Fault fault,
                                                 std::string_view text) {
  const auto words = text.empty() ? flatbuffers::Offset<flatbuffers::String>()
                                  : builder_.CreateString(text.data(), text.size());
  builder_.Finish(wire::CreateReply(builder_, id, fault, words), kReplyMark);
  return bytes();
}

const char* to_string(wire::Fault fault) noexcept {
  switch (fault) {
    case wire::Fault::None:
      return "done";
    case wire::Fault::Hello:
      return "a hello must come first";
    case wire::Fault::Version:
      return "another version of the protocol";
    case wire::Fault::Malformed:
      return "not a request of this protocol, or a value out of range";
    case wire::Fault::Denied:
      return "this socket is for looking only";
    case wire::Fault::Busy:
      return "busy, try again later";
    case wire::Fault::NotFound:
      return "not found";
    case wire::Fault::NoRoom:
      return "no room besides the pins and the largest pair of neighbours";
    case wire::Fault::StaleMap:
      return "the map has changed";
    case wire::Fault::Unavailable:
      return "not available here";
    case wire::Fault::TooMany:
      return "too many";
    case wire::Fault::Failed:
      return "failed";
  }
  return "unknown fault";
}

const char* to_string(wire::ZoneState state) noexcept {
  switch (state) {
    case wire::ZoneState::Absent:
      return "absent";
    case wire::ZoneState::Filling:
      return "filling";
    case wire::ZoneState::Cancelling:
      return "cancelling";
    case wire::ZoneState::Resident:
      return "resident";
  }
  return "unknown";
}

}  // namespace zonepack
