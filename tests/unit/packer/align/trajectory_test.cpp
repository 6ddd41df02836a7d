// SPDX-License-Identifier: Apache-2.0
#include "packer/align/trajectory.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

std::filesystem::path written(const test_support::TemporaryFolder& folder,
                              const std::string& text) {
  const std::filesystem::path path = folder.path() / "path.txt";
  std::ofstream(path) << text;
  return path;
}

std::string refusal(const std::string& text) {
  const test_support::TemporaryFolder folder;
  try {
    Trajectory::read(written(folder, text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Trajectory, IsReadInAnyOrderAndFoundByStamp) {
  const test_support::TemporaryFolder folder;
  const Trajectory path =
      Trajectory::read(written(folder, "# a comment\n\n2.5 1 2 3 0 0 0 1\r\n1.0 4 5 6 0 0 0 1\n"));
  ASSERT_EQ(path.positions().size(), 2u);
  EXPECT_EQ(path.at(1.004, 0.01), (Point3{4, 5, 6}));
  EXPECT_EQ(path.at(2.495, 0.01), (Point3{1, 2, 3}));
  EXPECT_EQ(path.at(1.5, 0.01), std::nullopt);
}

TEST(Trajectory, NamesTheLineThatIsWrong) {
  EXPECT_NE(refusal("1 2 3 4 0 0 0 1\n1 2 3\n").find(":2: 3 numbers"), std::string::npos);
  EXPECT_NE(refusal("1 2 x 4 0 0 0 1\n").find(":1: 'x' is no number"), std::string::npos);
  EXPECT_NE(refusal("1 2 nan 4 0 0 0 1\n").find("not finite"), std::string::npos);
  EXPECT_NE(refusal("1 2 3 4 0 0 0 1 9\n").find("more than 8"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n").find("holds no pose"), std::string::npos);
  EXPECT_NE(refusal("version https://git-lfs.github.com/spec/v1\n").find("Git LFS"),
            std::string::npos);
}

}  // namespace
}  // namespace zonepack::packer
