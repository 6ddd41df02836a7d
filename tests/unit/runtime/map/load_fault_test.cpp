// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/load_fault.hpp"

#include <gtest/gtest.h>

#include <cerrno>

#include "runtime/map/loader.hpp"

namespace zonepack {
namespace {

constexpr const char* kCopy =
    "; build the map again or copy the pack again, zonepack verify shows what is damaged";

class LoadFaultText : public testing::Test {
 protected:
  LoadFaultText() {
    map_.folder = "map";
    map_.zones.resize(1);
    map_.zones[0].name = "kitchen";
    map_.zones[0].pack = "kitchen-01.zpk";
  }
  // What stands behind zone and file, which every text names.
  std::string text(Error error) const {
    const std::string all = load_fault(map_, 0, error);
    const std::string front = "zone kitchen cannot be loaded: map/kitchen-01.zpk: ";
    EXPECT_TRUE(all.starts_with(front)) << all;
    return all.substr(std::min(all.size(), front.size()));
  }
  Catalog map_;
};

TEST_F(LoadFaultText, SaysWhatTheFileIsInsteadOfTheZonesPack) {
  EXPECT_EQ(text({ErrorCode::kNotFound}), std::string("not found") + kCopy);
  EXPECT_EQ(text({ErrorCode::kTruncated, 4711}),
            std::string("truncated: the file ends at byte 4711") + kCopy);
  EXPECT_EQ(text({ErrorCode::kBadChecksum, 16}), std::string("bad checksum at byte 16") + kCopy);
  EXPECT_EQ(text({ErrorCode::kBadCompression, 16}),
            std::string(to_string(ErrorCode::kBadCompression)) + " at byte 16" + kCopy);
  EXPECT_EQ(text({ErrorCode::kBadStructure, 16}),
            std::string(to_string(ErrorCode::kBadStructure)) + " at byte 16" + kCopy);
  EXPECT_EQ(text({ErrorCode::kBadVersion, 2}),
            std::string(to_string(ErrorCode::kBadVersion)) + " (2)" + kCopy);
}

TEST_F(LoadFaultText, TellsAPackOfAnotherMapFromOneThatTheManifestDescribesWrongly) {
  EXPECT_EQ(text({ErrorCode::kMismatch}),
            std::string("mismatch: it is not the pack that the manifest names") + kCopy);
  EXPECT_EQ(text({ErrorCode::kMismatch, kFalseClaim}),
            std::string("mismatch: it has other signatures, slots or chunks than the manifest "
                        "says") +
                kCopy);
}

TEST_F(LoadFaultText, NamesTheLimitThatAPackIsBeyond) {
  EXPECT_EQ(text(over_limit(LimitId::kDecodedBytes, 16385)),
            std::string("decoded bytes of a chunk: 16385, the format holds at most 16384") + kCopy);
  EXPECT_EQ(text({ErrorCode::kTooLarge, 1000}),
            std::string("its index takes 1000 bytes, more than the chunks that the manifest "
                        "counts in it") +
                kCopy);
}

TEST_F(LoadFaultText, SaysWhatToDoAboutWhatTheSystemRefuses) {
  const auto advice = [this](int number) {
    const std::string all = text({ErrorCode::kIo, number});
    return all.substr(std::min(all.size(), all.find("; ")));
  };
  EXPECT_EQ(advice(EACCES), "; let the user that zoned runs as read the map's folder and packs");
  EXPECT_EQ(advice(EPERM), advice(EACCES));
  EXPECT_EQ(advice(EMFILE), "; too many files are open, raise the limit (LimitNOFILE)");
  EXPECT_EQ(advice(ENFILE), advice(EMFILE));
  EXPECT_EQ(advice(EIO),
            "; look after the disk (dmesg shows what it said), then copy the map again");
}

}  // namespace
}  // namespace zonepack
