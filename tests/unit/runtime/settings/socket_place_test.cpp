// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/socket_place.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "platform/memory/account.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

class SocketPlace : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("ZONED_SOCKET");
    setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
  }
  void TearDown() override { unsetenv("ZONED_SOCKET"); }

  test_support::TemporaryFolder folder;
  ServeSettings settings;
};

TEST_F(SocketPlace, IsTheSystemsForRootAndTheUsersOwnForOthers) {
  const std::string own = folder / "zonepack/zoned.sock";
  EXPECT_EQ(usual_socket(true), kSystemSocket);
  EXPECT_EQ(usual_socket(false), own);
  EXPECT_EQ(usual_socket(), usual_socket(is_superuser()));
  setenv("XDG_RUNTIME_DIR", "", 1);
  EXPECT_EQ(usual_socket(false), kSystemSocket);
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(usual_socket(false), kSystemSocket);
}

TEST_F(SocketPlace, IsChosenByTheOptionThenTheEnvironmentThenTheSettings) {
  settings.socket = "/settings";
  EXPECT_EQ(listening_socket(std::nullopt, settings), "/settings");
  setenv("ZONED_SOCKET", "/environment", 1);
  EXPECT_EQ(listening_socket(std::nullopt, settings), "/environment");
  EXPECT_EQ(listening_socket("/option", settings), "/option");
  EXPECT_EQ(listening_socket("", settings), "");  // nobody is served
}

TEST_F(SocketPlace, ResolvesAutoToTheUsualPlace) {
  EXPECT_EQ(settings.socket, "auto");
  EXPECT_EQ(listening_socket(std::nullopt, settings), usual_socket());
}

}  // namespace
}  // namespace zonepack
