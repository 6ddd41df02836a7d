// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include "runtime/protocol/connection.hpp"

namespace zonepack {

// A connection of zonectl: what goes wrong is told on standard error, with what to do about it.
class CtlSession {
 public:
  explicit CtlSession(const std::string& socket);

  // Otherwise the user was told; exit with 1.
  bool ok() const noexcept { return connection_.has_value(); }
  Connection& connection() noexcept { return *connection_; }

  // The reply's body of that type, valid until the next; null when there is none, which was told.
  template <typename Body, typename Make>
  const Body* ask(Make make, std::span<const int> descriptors = {}) {
    MessageBuilder message;
    const auto body = make(message.builder());
    const auto reply = connection_->ask(message, body, descriptors);
    if (!reply) {
      tell(reply.error());
      return nullptr;
    }
    if ((*reply)->fault() != wire::Fault::None) {
      tell(**reply);
      return nullptr;
    }
    if ((*reply)->body_type() != wire::ReplyBodyTraits<Body>::enum_value) {
      tell(Error{ErrorCode::kBadStructure, 0});
      return nullptr;
    }
    return static_cast<const Body*>((*reply)->body());
  }

  // Waits for notices for as long; false when zoned is gone, which was told.
  bool listen(int timeout_ms);

 private:
  void tell(const Error& error) const;
  static void tell(const wire::Reply& refusal);

  std::string socket_;
  std::optional<Connection> connection_;
};

}  // namespace zonepack
