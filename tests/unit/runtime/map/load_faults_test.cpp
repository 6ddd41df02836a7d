// SPDX-License-Identifier: Apache-2.0
// What may happen to the file of a zone before and while it is loaded: each time that zone gives an
// error that says what happened, or loads correctly, and the other zone loads.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/fsuid.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "platform/sim/sim_storage.hpp"
#include "runtime/map/load_fault.hpp"
#include "tests/unit/runtime/map/two_zones.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

class LoadFaults : public testing::TestWithParam<ReadMode> {
 protected:
  explicit LoadFaults(std::int32_t signatures = 8)
      : map_(signatures), a_(*map_.load(0, GetParam())), b_(*map_.load(1, GetParam())) {}
  // Zone b, which is untouched, is as it was.
  ~LoadFaults() override { EXPECT_EQ(load(1), b_); }

  packer::Bytes load(ZoneId zone) {
    auto bytes = map_.load(zone, GetParam());
    return bytes ? *bytes : packer::Bytes();
  }
  Error why() { return map_.load(0, GetParam()).error(); }

  // A load of zone a after its first chunk.
  ZoneLoad begun() {
    Result<ZoneLoad> load = map_.begin(0, GetParam());
    EXPECT_TRUE(*load->step());
    return std::move(*load);
  }

  test_support::TwoZones map_;
  packer::Bytes a_, b_;
};

// Zones of which a part was not yet read ahead when something happens after the first chunk.
class LargeLoadFaults : public LoadFaults {
 protected:
  LargeLoadFaults() : LoadFaults(160) {
    EXPECT_GT(std::filesystem::file_size(map_.pack(0)), ReadQueue::kBytes + 100'000);
  }
};

TEST_P(LargeLoadFaults, CutShortWhileItIsLoaded) {
  ZoneLoad load = begun();
  std::filesystem::resize_file(map_.pack(0), kReadBufferBytes + 100);
  const auto rest = test_support::TwoZones::finish(load);
  EXPECT_EQ(rest.error(), (Error{ErrorCode::kTruncated, kReadBufferBytes + 100}));
  EXPECT_THAT(load_fault(map_.catalog(), 0, rest.error()),
              AllOf(HasSubstr("zone a "), HasSubstr(map_.pack(0).string()),
                    HasSubstr("ends at byte 65636"), HasSubstr("copy the pack again")));
  EXPECT_FALSE(map_.load(0, GetParam())) << "and from then on";
}

TEST_P(LargeLoadFaults, CutToNothingWhileItIsLoaded) {
  ZoneLoad load = begun();
  std::filesystem::resize_file(map_.pack(0), 0);
  EXPECT_EQ(test_support::TwoZones::finish(load).error(), (Error{ErrorCode::kTruncated, 0}));
  EXPECT_EQ(why(), (Error{ErrorCode::kTruncated, 0}));
}

TEST_P(LoadFaults, RemovedWhileItIsLoaded) {
  ZoneLoad load = begun();
  std::filesystem::remove(map_.pack(0));
  const auto rest = test_support::TwoZones::finish(load);
  ASSERT_TRUE(rest) << "an open file stays";
  EXPECT_EQ(*rest, a_);
  EXPECT_EQ(why().code, ErrorCode::kNotFound);
  EXPECT_THAT(load_fault(map_.catalog(), 0, why()), HasSubstr("not found"));
}

TEST_P(LoadFaults, ReplacedByRenameWhileItIsLoaded) {
  ZoneLoad load = begun();
  const auto copy = map_.pack(0).string() + ".new";
  std::filesystem::copy_file(map_.pack(1), copy);
  std::filesystem::rename(copy, map_.pack(0));
  const auto rest = test_support::TwoZones::finish(load);
  ASSERT_TRUE(rest) << "the load goes on with the file that it began with";
  EXPECT_EQ(*rest, a_);
  EXPECT_EQ(why().code, ErrorCode::kMismatch);
  EXPECT_THAT(load_fault(map_.catalog(), 0, why()), HasSubstr("not the pack that the manifest"));
}

TEST_P(LargeLoadFaults, OverwrittenInPlaceWhileItIsLoaded) {
  ZoneLoad load = begun();
  packer::Bytes other(std::filesystem::file_size(map_.pack(0)), std::byte{0x5A});
  {
    const int fd = ::open(map_.pack(0).c_str(), O_WRONLY | O_CLOEXEC);
    ASSERT_EQ(::pwrite(fd, other.data(), other.size(), 0), static_cast<ssize_t>(other.size()));
    ::close(fd);
  }
  EXPECT_EQ(test_support::TwoZones::finish(load).error().code, ErrorCode::kBadChecksum);
  EXPECT_EQ(why().code, ErrorCode::kBadMagic);
}

TEST_P(LoadFaults, NotAllowedAnyMore) {
  std::filesystem::permissions(map_.pack(0), std::filesystem::perms::none);
  if (::geteuid() == 0) ::setfsuid(65534);  // this thread only; root may read everything
  const Error refused = why();
  if (::geteuid() == 0) ::setfsuid(0);
  EXPECT_EQ(refused, (Error{ErrorCode::kIo, EACCES}));
  EXPECT_THAT(load_fault(map_.catalog(), 0, refused),
              AllOf(HasSubstr("Permission denied"), HasSubstr("let the user")));
}

TEST_P(LoadFaults, ADiskThatFailsInTheMiddle) {
  SimStorage disk;
  disk.fail_reads(map_.catalog().zones[0].pack, 100'000, {ErrorCode::kIo, EIO});
  EXPECT_EQ(why(), (Error{ErrorCode::kIo, EIO})) << "the index stands at the end";
  EXPECT_THAT(load_fault(map_.catalog(), 0, why()),
              AllOf(HasSubstr("Input/output error"), HasSubstr("dmesg")));
  disk.heal();
  {
    ZoneLoad started = begun();
    disk.fail_reads(map_.catalog().zones[0].pack, 100'000, {ErrorCode::kIo, EIO});
    EXPECT_EQ(test_support::TwoZones::finish(started).error(), (Error{ErrorCode::kIo, EIO}));
  }
  EXPECT_EQ(load(1), b_);
  disk.heal();
  EXPECT_EQ(load(0), a_);
}

const auto kModes =
    testing::Values(ReadMode::kDirect, ReadMode::kMapped, ReadMode::kBuffered, ReadMode::kCached);
INSTANTIATE_TEST_SUITE_P(Modes, LoadFaults, kModes);
INSTANTIATE_TEST_SUITE_P(Modes, LargeLoadFaults, kModes);

}  // namespace
}  // namespace zonepack
