// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/format.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::report {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light; }
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: #1f242b; background: #fff;
       max-width: 940px; margin: 0 auto; padding: 24px 20px 48px; }
h1 { font-size: 1.5rem; line-height: 1.25; margin: 0 0 .5rem; overflow-wrap: anywhere; }
h2 { font-size: 1.1rem; margin: 2.25rem 0 .25rem; }
p.headline { font-size: 1.1rem; margin: 0 0 1.25rem; }
p.caption, footer { color: #5c6570; font-size: .85rem; margin: 0 0 .75rem; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(165px, 1fr)); gap: 0 16px; margin: 0; }
dl div { border-top: 1px solid #e3e6ea; padding: .4rem 0 .6rem; }
dt { font-size: .8rem; color: #5c6570; }
dd { margin: 0; font-size: 1.15rem; font-weight: bold; }
dd small { display: block; font-size: .75rem; font-weight: normal; color: #5c6570; }
.bad dd { color: #c42b1c; }
figure { margin: 0; }
figure div, .table { overflow-x: auto; }
svg { display: block; width: 100%; min-width: 620px; height: auto; }
table { border-collapse: collapse; font-size: .85rem; width: 100%; }
th, td { padding: .25rem .7rem; text-align: left; border-bottom: 1px solid #e3e6ea; }
th { border-bottom: 2px solid #8a939e; vertical-align: bottom; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
footer { margin-top: 2.5rem; border-top: 1px solid #e3e6ea; padding-top: .75rem; overflow-wrap: anywhere; }
@media print { body { max-width: none; padding: 0; font-size: 11pt; }
               figure, tr, dl div { break-inside: avoid; } h2 { break-after: avoid; } }
)";

std::string element(std::string_view name, std::string_view text, std::string_view css = {}) {
  if (text.empty()) return {};
  std::string html = "<";
  html.append(name);
  if (!css.empty()) html.append(" class=\"").append(css).append("\"");
  return html.append(">").append(escape_xml(text)).append("</").append(name).append(">\n");
}

std::string facts_html(const std::vector<Fact>& facts) {
  if (facts.empty()) return {};
  std::string html = "<dl>\n";
  for (const Fact& fact : facts) {
    html += fact.bad ? "<div class=\"bad\">" : "<div>";
    html += "<dt>" + escape_xml(fact.name) + "</dt><dd>" + escape_xml(fact.value);
    if (!fact.note.empty()) html += "<small>" + escape_xml(fact.note) + "</small>";
    html += "</dd></div>\n";
  }
  return html + "</dl>\n";
}

std::string table_html(const Table& table) {
  std::string html = element("h2", table.title) + element("p", table.caption, "caption") +
                     "<div class=\"table\"><table>\n<thead><tr>";
  const auto cells = [&](std::string_view tag, const auto& text_of) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      html.append("<").append(tag).append(table.columns[i].number ? " class=\"n\">" : ">");
      html.append(escape_xml(text_of(i))).append("</").append(tag).append(">");
    }
  };
  cells("th", [&](std::size_t i) { return table.columns[i].name; });
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    cells("td", [&](std::size_t i) { return i < row.size() ? row[i] : std::string(); });
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string to_html(const Report& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
      escape_xml(report.title) + "</title>\n<style>";
  html.append(kStyle).append("</style>\n</head>\n<body>\n");
  html += element("h1", report.title) + element("p", report.headline, "headline");
  html += facts_html(report.facts);
  for (const Figure& figure : report.figures) {
    html += "<figure>\n" + element("h2", figure.title) + element("p", figure.caption, "caption") +
            "<div>\n" + figure.drawing.inline_text() + "</div>\n</figure>\n";
  }
  for (const Table& table : report.tables) html += table_html(table);
  return html + element("footer", report.origin) + "</body>\n</html>\n";
}

}  // namespace zonepack::report
