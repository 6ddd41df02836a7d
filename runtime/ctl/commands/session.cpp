// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/session.hpp"

#include <cerrno>
#include <cstring>

namespace zonepack {
namespace {

std::string advice(const Error& error) {
  switch (error.code) {
    case ErrorCode::kNotFound:
      return "no zoned listens there; start zoned run, or name its socket by --socket, "
             "ZONED_SOCKET or --config";
    case ErrorCode::kBusy:
      return "zoned does not answer, or has too many clients; try again";
    case ErrorCode::kCancelled:
      return "zoned has closed the connection";
    case ErrorCode::kBadVersion:
      return "zoned speaks another version of the protocol; use the zonectl that came with it";
    case ErrorCode::kIo:
      return std::strerror(static_cast<int>(error.detail)) +
             std::string(error.detail == EACCES ? "; the mode and group of the socket decide who "
                                                  "may (serve.mode)"
                                                : "");
    default:
      return std::string("not understood: ") + to_string(error.code);
  }
}

}  // namespace

Outcome<CtlSession> CtlSession::open(const std::string& socket) {
  Result<Connection> connection = Connection::open(socket, "zonectl");
  if (!connection) return explain(socket, connection.error());
  return CtlSession(socket, std::move(connection).value());
}

Outcome<void> CtlSession::listen(int timeout_ms) {
  if (const auto heard = connection_.listen(timeout_ms); !heard) {
    return explain(socket_, heard.error());
  }
  return {};
}

Failure CtlSession::explain(const std::string& socket, const Error& error) {
  return failure(socket + ": " + advice(error), error.code);
}

Failure CtlSession::refusal(const wire::Reply& reply) {
  std::string message = to_string(reply.fault());
  if (reply.text() != nullptr) message += ": " + reply.text()->str();
  return failure(message);
}

}  // namespace zonepack
