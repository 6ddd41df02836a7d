// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>

#include "platform/base/failure.hpp"
#include "runtime/protocol/connection.hpp"

namespace zonepack {

// A connection of zonectl, whose failures say what to do about them.
class CtlSession {
 public:
  static Outcome<CtlSession> open(const std::string& socket);

  Connection& connection() noexcept { return connection_; }

  // The reply's body of that type, valid until the next call; never null.
  template <typename Body, typename Make>
  Outcome<const Body*> ask(Make make, std::span<const int> descriptors = {}) {
    MessageBuilder message;
    const auto body = make(message.builder());
    const auto reply = connection_.ask(message, body, descriptors);
    if (!reply) return explain(socket_, reply.error());
    if ((*reply)->fault() != wire::Fault::None) return refusal(**reply);
    if ((*reply)->body_type() != wire::ReplyBodyTraits<Body>::enum_value) {
      return explain(socket_, {ErrorCode::kBadStructure, 0});
    }
    return static_cast<const Body*>((*reply)->body());
  }

  // Waits for notices for timeout_ms; fails when zoned is gone.
  Outcome<void> listen(int timeout_ms);

 private:
  CtlSession(std::string socket, Connection connection)
      : socket_(std::move(socket)), connection_(std::move(connection)) {}

  static Failure explain(const std::string& socket, const Error& error);
  static Failure refusal(const wire::Reply& reply);

  std::string socket_;
  Connection connection_;
};

}  // namespace zonepack
