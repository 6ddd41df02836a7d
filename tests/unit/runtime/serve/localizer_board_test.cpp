// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/localizer_board.hpp"

#include <gtest/gtest.h>

#include "runtime/protocol/messages.hpp"
#include "tests/unit/runtime/serve/fake_run.hpp"

namespace zonepack {
namespace {

using testing_support::Client;
using testing_support::FakeRun;
using testing_support::Serving;
using testing_support::soon;

class LocalizerReports : public testing::Test {
 protected:
  void SetUp() override {
    run.catalog.detector = "8";
    ASSERT_TRUE(run.open());
  }

  static wire::Fault report(Client& client, std::uint64_t images, const std::string& camera,
                            std::vector<std::string> reasons = {"few_matches"}) {
    return client
        .ask([&](auto& b) {
          std::vector<flatbuffers::Offset<wire::FixReason>> list;
          for (const std::string& reason : reasons) {
            const auto text = b.CreateString(reason);
            list.push_back(wire::CreateFixReason(b, text, 2));
          }
          const wire::Timing latency(5, 30'000'000, 50'000'000, 0, 0, 60'000'000);
          const auto rows = b.CreateVector(list);
          const auto name = b.CreateString(camera);
          return wire::CreateReportLocalizer(
              b, wire::CreateLocalizer(b, name, images, 3, 1, 4, &latency, nullptr, rows));
        })
        .fault();
  }
  static std::size_t shown(Client& client) { return client.status().localizers()->size(); }

  FakeRun run;
};

TEST_F(LocalizerReports, AreShownUntilTheLocalizerLeaves) {
  const Serving serving(run);
  Client looker(run.settings.socket);
  EXPECT_EQ(shown(looker), 0U);
  {
    Client localizer(run.settings.socket);
    EXPECT_EQ(localizer.connection().welcome().detector()->str(), "8");
    EXPECT_EQ(report(localizer, 5, "v4l2:/dev/video0"), wire::Fault::None);
    EXPECT_EQ(report(localizer, 7, "v4l2:/dev/video0"), wire::Fault::None);
    const auto& rows = *looker.status().localizers();
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows.Get(0)->camera()->str(), "v4l2:/dev/video0");
    EXPECT_EQ(rows.Get(0)->images_total(), 7U);
    EXPECT_EQ(rows.Get(0)->fixes_total(), 3U);
    EXPECT_EQ(rows.Get(0)->latency()->p99(), 50'000'000);
    EXPECT_EQ(rows.Get(0)->reasons()->Get(0)->reason()->str(), "few_matches");
    EXPECT_EQ(rows.Get(0)->reasons()->Get(0)->images(), 2U);
  }
  EXPECT_TRUE(soon([&] { return shown(looker) == 0; }));
}

TEST_F(LocalizerReports, OfAFifthLocalizerFindNoRoom) {
  const Serving serving(run);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 5; ++i) {
    clients.push_back(std::make_unique<Client>(run.settings.socket));
    EXPECT_EQ(report(*clients.back(), 1, "c"), i < 4 ? wire::Fault::None : wire::Fault::TooMany);
  }
}

TEST_F(LocalizerReports, OverTheLimitsAreRefusedAndChangeNothing) {
  const Serving serving(run);
  Client localizer(run.settings.socket);
  EXPECT_EQ(report(localizer, 1, std::string(128, 'c'), std::vector<std::string>(16, "r")),
            wire::Fault::None);
  EXPECT_EQ(report(localizer, 2, std::string(129, 'c')), wire::Fault::Malformed);
  EXPECT_EQ(report(localizer, 2, "c", {std::string(33, 'r')}), wire::Fault::Malformed);
  EXPECT_EQ(report(localizer, 2, "c", std::vector<std::string>(17, "r")), wire::Fault::Malformed);
  EXPECT_EQ(report(localizer, 2, "c\x1b[2J"), wire::Fault::Malformed);
  EXPECT_EQ(localizer.status().localizers()->Get(0)->images_total(), 1U);
}

// Four of the longest reports and all lines of a robot fit into a message.
TEST_F(LocalizerReports, FitIntoAStatus) {
  const Serving serving(run);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<Client>(run.settings.socket));
    EXPECT_EQ(report(*clients.back(), 1, std::string(128, 'c'),
                     std::vector<std::string>(16, std::string(32, 'r'))),
              wire::Fault::None);
  }
  EXPECT_EQ(shown(*clients[0]), 4U);
}

TEST_F(LocalizerReports, AreNotForTheSocketThatOnlyLooks) {
  run.server.reset();
  run.settings.looking_socket = run.folder / "look";
  ASSERT_TRUE(run.open());
  const Serving serving(run);
  Client looker(run.settings.looking_socket);
  EXPECT_EQ(report(looker, 1, "c"), wire::Fault::Denied);
}

}  // namespace
}  // namespace zonepack
