// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "platform/base/result.hpp"
#include "runtime/protocol/protocol_generated.h"

// Messages of the socket as bytes, for both ends. PROTOCOL.md says what they mean.
namespace zonepack {

inline constexpr std::uint32_t kProtocolVersion = 1;
inline constexpr std::size_t kMostMessageBytes = std::size_t{16} * 1024;  // either way
inline constexpr std::uint32_t kMostNearest = 64;
inline constexpr double kMostNearestRadius_m = 1000;
inline constexpr std::size_t kMostRouteHint = 64;
inline constexpr float kMostPoseHz = 100;
// The longest time between two poses, a day, however low a rate is asked for.
inline constexpr double kLongestPosePeriod_ns = 86'400e9;
inline constexpr std::size_t kMostNameBytes = 64;

// The request or reply in `bytes`, which it points into; `bytes` must be aligned to 8. kTooLarge,
// or kBadStructure for anything but a whole message of this protocol. Everything that a returned
// message refers to lies inside `bytes`.
Result<const wire::Request*> check_request(std::span<const std::byte> bytes) noexcept;
Result<const wire::Reply*> check_reply(std::span<const std::byte> bytes) noexcept;

// A message under construction. Create its parts in builder(), then finish; one message each.
class MessageBuilder {
 public:
  MessageBuilder() : builder_(1024) {}

  flatbuffers::FlatBufferBuilder& builder() noexcept { return builder_; }

  // bytes() refers to this object.
  template <typename Body>
  std::span<const std::byte> request(std::uint64_t id, flatbuffers::Offset<Body> body,
                                     std::uint32_t map_serial = 0) {
    const auto kind = wire::RequestBodyTraits<Body>::enum_value;
    builder_.Finish(wire::CreateRequest(builder_, id, map_serial, kind, body.Union()), "ZPQ1");
    return bytes();
  }
  template <typename Body>
  std::span<const std::byte> reply(std::uint64_t id, flatbuffers::Offset<Body> body) {
    const auto kind = wire::ReplyBodyTraits<Body>::enum_value;
    builder_.Finish(wire::CreateReply(builder_, id, wire::Fault::None, 0, kind, body.Union()),
                    "ZPA1");
    return bytes();
  }
  std::span<const std::byte> fault(std::uint64_t id, wire::Fault fault, std::string_view text = {});

 private:
  std::span<const std::byte> bytes() const noexcept {
    return std::as_bytes(std::span(builder_.GetBufferPointer(), builder_.GetSize()));
  }
  flatbuffers::FlatBufferBuilder builder_;
};

// "no room": for messages to people.
const char* to_string(wire::Fault fault) noexcept;
const char* to_string(wire::ZoneState state) noexcept;

inline std::string_view view_of(const flatbuffers::String* text) noexcept {
  return text == nullptr ? std::string_view() : std::string_view(text->c_str(), text->size());
}

}  // namespace zonepack
