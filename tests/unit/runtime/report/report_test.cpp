// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/report.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "runtime/report/chart.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

namespace fs = std::filesystem;

Report sample() {
  Svg drawing(900, 100);
  drawing.text({10, 20}, "drawn", {});
  Report report;
  report.title = "Map <hospital>";
  report.headline = "24 zones & 185 signatures.";
  report.origin = "zonepack";
  report.facts = {{.name = "zones", .value = "24", .note = "", .bad = false},
                  {.name = "budget violations", .value = "3", .note = "must be 0", .bad = true}};
  report.figures.push_back({.title = "Plan", .caption = "How to read it.", .drawing = drawing});
  report.tables.push_back({.title = "Zones",
                           .caption = "By name.",
                           .columns = {{.name = "Zone"}, {.name = "Bytes", .number = true}},
                           .rows = {{"L1", "12"}, {"H1"}}});
  return report;
}

class ReportFileTest : public testing::Test {
 protected:
  std::string path(const char* name) const { return (folder_ / name).string(); }
  static std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  test_support::TemporaryFolder folder_;
};

TEST(Report, AsAPageIsWellFormedAndHoldsEverything) {
  const std::string html = to_html(sample());
  EXPECT_EQ(XmlCheck::problem_in(html), "");
  for (const char* part :
       {"<h1>Map &lt;hospital&gt;</h1>", "24 zones &amp; 185 signatures.", ">drawn</text>",
        "How to read it.", "<td>L1</td><td class=\"n\">12</td>", "<td>H1</td><td class=\"n\"></td>",
        "<div class=\"bad\"><dt>budget violations</dt>"}) {
    EXPECT_EQ(count_of(html, part), 1u) << part;
  }
}

TEST(Report, AsAPageNeedsNothingFromOutside) {
  const std::string html = to_html(sample());
  for (const char* part :
       {"<script src", " src=", "href=", "url(", "@import", "fetch(", "import("}) {
    EXPECT_EQ(count_of(html, part), 0u) << part;
  }
  // The namespace of SVG is a name, not a resource; the policy forbids what would be one.
  EXPECT_EQ(count_of(html, "http://"), count_of(html, "http://www.w3.org/2000/svg"));
  EXPECT_EQ(count_of(html, "https://"), 0u);
  EXPECT_EQ(count_of(html, "default-src 'none'"), 1u);
}

TEST(Report, AsAPageHasANarrowDrawingForPhonesAndOneForPrint) {
  Report report = sample();
  Svg narrow(340, 100);
  narrow.text({10, 20}, "drawn small", {});
  report.figures[0].narrow = narrow;
  const std::string html = to_html(report);
  EXPECT_EQ(XmlCheck::problem_in(html), "");
  EXPECT_EQ(count_of(html, "<div class=\"drawing wide\" role=\"img\" aria-label=\"Plan\">"), 1u);
  EXPECT_EQ(count_of(html, "<div class=\"drawing narrow\" role=\"img\" aria-label=\"Plan\">"), 1u);
  EXPECT_EQ(count_of(to_sheet(report).file_text(), "drawn small"), 0u);
}

TEST(Report, AsAPageGivesEveryColourATwinForTheDark) {
  const std::string html = to_html(sample());
  // The one text of the drawing is ink.
  EXPECT_EQ(count_of(html, ":root{--c1f242b:#1f242b;}"), 1u);
  EXPECT_EQ(count_of(html, "--c1f242b:" + to_hex(dark_twin(kInk)) + ";"), 2u);
  EXPECT_EQ(count_of(html, "svg [fill=\"#1f242b\"]:not(.on){fill:var(--c1f242b)}"), 1u);
}

TEST(Report, NoNameEndsTheScriptsData) {
  Report report = sample();
  Chart chart;
  chart.series.emplace_back().name = "</script><script>alert('1')</script>";
  report.figures[0].data = chart_json(chart);
  report.playback.emplace();
  report.playback->events = {{1, "<!--<script>&\"\\\xff", 0}};
  const std::string html = to_html(report);
  EXPECT_EQ(XmlCheck::problem_in(html), "");
  EXPECT_EQ(count_of(html, "<script"), 2u);  // the data and the page's own
  EXPECT_EQ(count_of(html, "alert('1')\\u003c/script\\u003e"), 1u);
  EXPECT_EQ(count_of(html, "\"\\u003c!--\\u003cscript\\u003e\\u0026\\\"\\\\\xEF\xBF\xBD\""), 1u);
}

TEST(Report, AsASheetHoldsEverything) {
  const std::string svg = to_sheet(sample()).file_text();
  EXPECT_EQ(XmlCheck::problem_in(svg), "");
  for (const char* part :
       {">Map &lt;hospital&gt;<", ">drawn<", ">How to read it.<", ">12<", ">must be 0<"}) {
    EXPECT_EQ(count_of(svg, part), 1u) << part;
  }
}

TEST(Report, AWideTableGivesWayInItsWidestColumn) {
  Report report;
  report.tables.push_back({"T",
                           "",
                           {{"Zone"}, {"Label"}, {"Bytes", true}},
                           {{"L1", std::string(400, 'w'), "1234567"}}});
  const std::string svg = to_sheet(report).file_text();
  EXPECT_EQ(count_of(svg, std::string(400, 'w')), 0u);
  EXPECT_EQ(count_of(svg, "www...</text>"), 1u);
  // The last column still ends inside the sheet: 940 px less its margin of 20.
  EXPECT_EQ(count_of(svg, "<text x=\"920\""), 2u);
}

TEST(Report, WithNothingInItIsStillAPageAndASheet) {
  EXPECT_EQ(XmlCheck::problem_in(to_html(Report{})), "");
  EXPECT_EQ(XmlCheck::problem_in(to_sheet(Report{}).file_text()), "");
}

TEST_F(ReportFileTest, TheNameDecidesTheKind) {
  EXPECT_TRUE(write_report(path("r.html"), sample()));
  EXPECT_EQ(read(path("r.html")), to_html(sample()));
  EXPECT_TRUE(write_report(path("r.svg"), sample()));
  EXPECT_EQ(read(path("r.svg")), to_sheet(sample()).file_text());
  EXPECT_TRUE(write_report(path("r.png"), sample()));
  EXPECT_TRUE(read(path("r.png")).starts_with("\x89PNG\r\n"));
}

TEST_F(ReportFileTest, AnotherNameIsRefusedWithWhatIsAllowed) {
  const Outcome<void> written = write_report(path("r.pdf"), sample());
  ASSERT_FALSE(written);
  EXPECT_EQ(exit_code(written.error()), 2);
  EXPECT_FALSE(check_report_name(path("r.pdf")));
  EXPECT_TRUE(check_report_name(path("r.png")));
  EXPECT_NE(written.error().message.find(path("r.pdf")), std::string::npos);
  EXPECT_NE(written.error().message.find(".html, .svg or .png"), std::string::npos);
}

TEST_F(ReportFileTest, AMissingFolderIsNamed) {
  const Outcome<void> written = write_report(path("no/r.html"), sample());
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("there is no folder " + path("no") + "; mkdir -p "),
            std::string::npos);
}

TEST_F(ReportFileTest, WithoutRsvgConvertItSaysWhatToInstallAndLeavesNothing) {
  const std::string old = ::getenv("PATH");
  ::setenv("PATH", folder_.path().c_str(), 1);
  const Outcome<void> written = write_report(path("r.png"), sample());
  ::setenv("PATH", old.c_str(), 1);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("librsvg2-bin"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ReportFileTest, AFailingRsvgConvertLeavesTheOldPicture) {
  std::ofstream(path("r.png")) << "old";
  std::ofstream(path("rsvg-convert")) << "#!/bin/sh\nexit 3\n";
  fs::permissions(path("rsvg-convert"), fs::perms::owner_all);
  const std::string old = ::getenv("PATH");
  ::setenv("PATH", folder_.path().c_str(), 1);
  const Outcome<void> written = write_report(path("r.png"), sample());
  ::setenv("PATH", old.c_str(), 1);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("status 3"), std::string::npos);
  EXPECT_EQ(read(path("r.png")), "old");
}

}  // namespace
}  // namespace zonepack::report
