// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <utility>

#include "platform/base/require.hpp"

namespace zonepack {

// Why a call failed. Plain values, so that the control thread can return them; above it they become
// a Failure (failure.hpp) with the file, zone or key that is known there.
enum class ErrorCode : std::uint16_t {
  kOk = 0,
  kNotFound,     // a file, zone or key that does not exist
  kIo,           // the system refused to read or write; detail is errno
  kTooLarge,     // over a limit of the format or the budget; detail is the need in bytes or items
  kTruncated,    // fewer bytes than the structure declares; detail is the offset
  kBadMagic,     // not a file of this kind
  kBadVersion,   // a format version this reader does not read; detail is the version
  kBadChecksum,  // bytes are not those that were written; detail is the offset
  kBadCompression,  // LZ4 block does not decode to its declared size
  kBadStructure,    // FlatBuffer or table breaks its rules
  kBadValue,        // a value outside its documented range
  kMismatch,        // two places that must agree do not (manifest and pack, pack and chunk)
  kExists,          // a name is taken
  kBusy,            // cannot be done now; try again later
  kNoRoom,          // would fit only if something protected were evicted
  kCancelled,       // abandoned on request
  kUsage,           // the caller asked for something meaningless; a program exits with 2
};

struct Error {
  ErrorCode code = ErrorCode::kOk;
  std::int64_t detail = 0;
  friend bool operator==(const Error&, const Error&) = default;
};

// A stable lower-case word for the code ("bad checksum").
const char* to_string(ErrorCode code) noexcept;

// A value, or the reason why there is none.
template <typename T, typename E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT: implicit by intent
  Result(E error) : error_(std::move(error)) {   // NOLINT: implicit by intent
    ZP_REQUIRE(error_.code != ErrorCode::kOk);
  }
  Result(ErrorCode code, std::int64_t detail = 0) requires std::same_as<E, Error>
      : Result(Error{code, detail}) {}

  bool ok() const noexcept { return value_.has_value(); }
  explicit operator bool() const noexcept { return ok(); }
  const E& error() const& noexcept { return error_; }
  E error() && noexcept { return std::move(error_); }
  T& value() & noexcept {
    ZP_REQUIRE(ok());
    return *value_;
  }
  const T& value() const& noexcept {
    ZP_REQUIRE(ok());
    return *value_;
  }
  T&& value() && noexcept {
    ZP_REQUIRE(ok());
    return std::move(*value_);
  }
  T& operator*() & noexcept { return value(); }
  const T& operator*() const& noexcept { return value(); }
  T&& operator*() && noexcept { return std::move(*this).value(); }
  T* operator->() noexcept { return &value(); }
  const T* operator->() const noexcept { return &value(); }

 private:
  std::optional<T> value_;
  E error_;
};

// Success or a reason.
template <typename E>
class [[nodiscard]] Result<void, E> {
 public:
  Result() = default;
  Result(E error) : error_(std::move(error)) {}  // NOLINT: implicit by intent
  Result(ErrorCode code, std::int64_t detail = 0) requires std::same_as<E, Error>
      : error_{code, detail} {}

  bool ok() const noexcept { return error_.code == ErrorCode::kOk; }
  explicit operator bool() const noexcept { return ok(); }
  const E& error() const& noexcept { return error_; }
  E error() && noexcept { return std::move(error_); }

 private:
  E error_;
};

}  // namespace zonepack
