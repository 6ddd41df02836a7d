// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/session.hpp"

#include <cerrno>
#include <cstring>

namespace zonepack {

CtlSession::CtlSession(const std::string& socket) : socket_(socket) {
  Result<Connection> connection = Connection::open(socket, "zonectl");
  if (connection) {
    connection_.emplace(std::move(connection).value());
  } else {
    tell(connection.error());
  }
}

bool CtlSession::listen(int timeout_ms) {
  const auto heard = connection_->listen(timeout_ms);
  if (!heard) tell(heard.error());
  return heard.ok();
}

void CtlSession::tell(const Error& error) const {
  std::cerr << "zonectl: " << socket_ << ": ";
  switch (error.code) {
    case ErrorCode::kNotFound:
      std::cerr << "no zoned listens there; start zoned run, or name its socket by --socket, "
                   "ZONED_SOCKET or --config";
      break;
    case ErrorCode::kBusy:
      std::cerr << "zoned does not answer, or has too many clients; try again";
      break;
    case ErrorCode::kCancelled:
      std::cerr << "zoned has closed the connection";
      break;
    case ErrorCode::kBadVersion:
      std::cerr << "zoned speaks another version of the protocol; use the zonectl that came with "
                   "it";
      break;
    case ErrorCode::kIo:
      std::cerr << std::strerror(static_cast<int>(error.detail));
      if (error.detail == EACCES) {
        std::cerr << "; the mode and group of the socket decide who may (serve.mode)";
      }
      break;
    default:
      std::cerr << "not understood: " << to_string(error.code);
  }
  std::cerr << '\n';
}

void CtlSession::tell(const wire::Reply& refusal) {
  std::cerr << "zonectl: " << to_string(refusal.fault());
  if (refusal.text() != nullptr) std::cerr << ": " << refusal.text()->str();
  std::cerr << '\n';
}

}  // namespace zonepack
