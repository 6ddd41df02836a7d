// SPDX-License-Identifier: Apache-2.0
#include "runtime/protocol/messages.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace zonepack {
namespace {

// Bytes at an address that is a multiple of 8.
class Aligned {
 public:
  explicit Aligned(std::span<const std::byte> bytes)
      : words_(bytes.size() / 8 + 1), size_(bytes.size()) {
    std::memcpy(words_.data(), bytes.data(), bytes.size());
  }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(words_)).first(size_); }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t size_;
};

TEST(Messages, AreReadAsTheyWereWritten) {
  MessageBuilder message;
  const wire::Pose pose(1, 2, 3);
  const wire::Covariance covariance(1, 0, 0, 1, 0, 1);
  const auto body =
      wire::CreateGivePose(message.builder(), wire::Clock::Realtime, 5, &pose, &covariance);
  Aligned copy(message.request(42, body, 9));
  const auto request = check_request(copy.bytes());
  ASSERT_TRUE(request.ok());
  EXPECT_EQ((*request)->id(), 42u);
  EXPECT_EQ((*request)->map_serial(), 9u);
  ASSERT_NE((*request)->body_as_GivePose(), nullptr);
  EXPECT_EQ((*request)->body_as_GivePose()->pose()->y(), 2);
}

TEST(Messages, OfTheOtherKindOrOfNoKindAreRefused) {
  MessageBuilder message;
  Aligned reply(message.reply(1, wire::CreateDone(message.builder())));
  EXPECT_TRUE(check_reply(reply.bytes()).ok());
  EXPECT_EQ(check_request(reply.bytes()).error().code, ErrorCode::kBadStructure);
  EXPECT_EQ(check_request({}).error().code, ErrorCode::kBadStructure);
  Aligned large(std::vector<std::byte>(kMostMessageBytes + 1));
  EXPECT_EQ(check_request(large.bytes()).error().code, ErrorCode::kTooLarge);
}

TEST(Messages, CutAnywhereAreRefused) {
  MessageBuilder message;
  const auto name = message.builder().CreateString("lobby");
  Aligned whole(message.request(1, wire::CreatePin(message.builder(), 0, name)));
  // The name was written first, so it comes last: five letters, the zero after them, padding.
  const std::size_t least = whole.bytes().size() - 2;
  for (std::size_t size = 0; size < whole.bytes().size(); ++size) {
    Aligned part(whole.bytes().first(size));
    EXPECT_EQ(check_request(part.bytes()).ok(), size >= least) << size;
  }
}

TEST(Messages, ATextOfAFaultIsCarried) {
  MessageBuilder message;
  Aligned copy(message.fault(3, wire::Fault::NotFound, "no zone \"x\""));
  const auto reply = check_reply(copy.bytes());
  ASSERT_TRUE(reply.ok());
  EXPECT_EQ((*reply)->fault(), wire::Fault::NotFound);
  EXPECT_EQ(view_of((*reply)->text()), "no zone \"x\"");
  EXPECT_EQ((*reply)->body(), nullptr);
}

}  // namespace
}  // namespace zonepack
