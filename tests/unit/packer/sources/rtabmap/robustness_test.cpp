// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a database file holds, reading it ends in data or in a message. Most useful under
// the sanitizers (presets asan and tsan).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int opened = 0, refused = 0, read = 0, damaged = 0;
};

void read_everything(const fs::path& path, Outcome& outcome) {
  try {
    RtabmapDatabase database(path);
    ++outcome.opened;
    SignatureRecord record;
    for (const NodeOutline& node : database.outline().nodes) {
      try {
        database.read(node.id, PayloadSet(), record);
        ++outcome.read;
      } catch (const DamagedSignature& error) {
        EXPECT_EQ(error.damage().signature, node.id);
        ++outcome.damaged;
      }
    }
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find(path.string()), 0u) << error.what();
    ++outcome.refused;
  }
}

class AnyBytes : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path whole = folder_ / "whole.db";
    write_rtabmap_database(whole, test_support::one_of_everything("0.23.8"));
    std::ifstream in(whole, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), {});
  }

  void read(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    read_everything(path_, outcome_);
  }

  test_support::TemporaryFolder folder_;
  fs::path path_ = folder_ / "broken.db";
  std::string bytes_;
  Outcome outcome_;
};

TEST_F(AnyBytes, FlippedAnywhereAreReadOrReported) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    std::string bytes = bytes_;
    const std::size_t flips = 1 + random() % 20;
    for (std::size_t i = 0; i < flips; ++i) {
      bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
    }
    read(bytes);
  }
  EXPECT_GT(outcome_.read, 0);
  EXPECT_GT(outcome_.damaged, 0);
  EXPECT_GT(outcome_.opened, 0);
}

TEST_F(AnyBytes, FlippedInPageHeadersAreReadOrReported) {
  std::mt19937 random(2);
  constexpr std::size_t kPage = 4096;
  for (int round = 0; round < 200; ++round) {
    std::string bytes = bytes_;
    for (int i = 0; i < 3; ++i) {
      const std::size_t page = random() % (bytes.size() / kPage);
      bytes[page * kPage + random() % 64] = static_cast<char>(random());
    }
    read(bytes);
  }
  EXPECT_GT(outcome_.damaged + outcome_.refused, 0);
}

TEST_F(AnyBytes, CutAnywhereAreReadOrReported) {
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) read(bytes_.substr(0, random() % bytes_.size()));
  EXPECT_GT(outcome_.refused, 0);
}

TEST_F(AnyBytes, InAnyBlobAreReadOrReported) {
  const fs::path path = folder_ / "blobs.db";
  write_rtabmap_database(path, test_support::one_of_everything("0.23.8"));
  std::mt19937 random(4);
  const std::vector<std::pair<std::string, std::string>> columns = {{"Data", "image"},
                                                                    {"Data", "depth"},
                                                                    {"Data", "calibration"},
                                                                    {"Data", "scan"},
                                                                    {"Data", "scan_info"},
                                                                    {"Data", "ground_cells"},
                                                                    {"Data", "empty_cells"},
                                                                    {"Data", "obstacle_cells"},
                                                                    {"Data", "user_data"},
                                                                    {"Node", "pose"},
                                                                    {"Node", "env_sensors"},
                                                                    {"Link", "information_matrix"},
                                                                    {"Link", "transform"},
                                                                    {"Feature", "descriptor"},
                                                                    {"GlobalDescriptor", "data"},
                                                                    {"Data", "depth_confidence"}};
  for (int round = 0; round < 200; ++round) {
    const auto& [table, column] = columns[random() % columns.size()];
    Bytes noise(random() % 200);
    for (std::byte& byte : noise) byte = static_cast<std::byte>(random());
    if (round % 2 == 0 && noise.size() > 16) {
      // Bytes that start like valid content.
      static const Bytes kRvl = test_support::rvl(4, 4, std::vector<std::uint16_t>(16, 900));
      static const Bytes kPng = test_support::png(2, 2, 8, 0, Bytes(4, std::byte{1}));
      const Bytes& like = round % 4 == 0 ? kRvl : kPng;
      std::copy(like.begin(), like.begin() + 16, noise.begin());
    }
    test_support::execute(path,
                          "UPDATE " + table + " SET " + column + "=?1 WHERE rowid=1+" +
                              std::to_string(random() % 24) + "%(SELECT max(rowid) FROM " + table +
                              ")",
                          noise);
    if (round % 10 == 9) read_everything(path, outcome_);
  }
  EXPECT_GT(outcome_.damaged, 0);
  EXPECT_GT(outcome_.read, 0);
}

}  // namespace
}  // namespace zonepack::packer
