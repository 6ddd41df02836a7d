// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "runtime/report/format.hpp"
#include "runtime/report/page_texts.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::report {
namespace {

// Nothing from outside, whatever the names in the page hold.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

std::string element(std::string_view name, std::string_view text, std::string_view css = {}) {
  if (text.empty()) return {};
  std::string html = "<";
  html.append(name);
  if (!css.empty()) html.append(" class=\"").append(css).append("\"");
  return html.append(">").append(escape_xml(text)).append("</").append(name).append(">\n");
}

// Colours of the drawings as variables of the page, and their twins where the page is dark: on a
// screen only, since paper is white.
std::string color_rules(const Report& report) {
  std::set<Color> colors;
  for (const Figure& figure : report.figures) {
    for (const Svg* drawing : {&figure.drawing, figure.narrow ? &*figure.narrow : nullptr}) {
      if (drawing != nullptr) colors.insert(drawing->colors().begin(), drawing->colors().end());
    }
  }
  std::string light, dark, use;
  for (const Color color : colors) {
    const std::string hex = to_hex(color), variable = "--c" + hex.substr(1);
    light += variable + ":" + hex + ";";
    dark += variable + ":" + to_hex(dark_twin(color)) + ";";
    use += "svg [fill=\"" + hex + "\"]:not(.on){fill:var(" + variable + ")}svg [stroke=\"" + hex +
           "\"]{stroke:var(" + variable + ")}\n";
  }
  if (colors.empty()) return {};
  return ":root{" + light +
         "}\n@media screen and (prefers-color-scheme: dark){:root:not([data-theme=\"light\"]){" +
         dark + "}}\n@media screen{:root[data-theme=\"dark\"]{" + dark + "}}\n" + use;
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

std::string drawing_html(const Figure& figure, const Svg& drawing, std::string_view css) {
  std::string html = "<div class=\"drawing ";
  html.append(css).append("\" role=\"img\" aria-label=\"").append(escape_xml(figure.title));
  return html.append("\">\n").append(drawing.inline_text()).append("</div>\n");
}

std::string figure_html(const Figure& figure) {
  std::string html =
      "<figure>\n" + element("h2", figure.title) + element("p", figure.caption, "caption");
  if (!figure.narrow) return html + drawing_html(figure, figure.drawing, "any") + "</figure>\n";
  return html + drawing_html(figure, figure.drawing, "wide") +
         drawing_html(figure, *figure.narrow, "narrow") + "</figure>\n";
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

// One entry a figure, null where the script has nothing to do.
std::string data_json(const Report& report) {
  std::string json = "{\"figures\":[";
  for (std::size_t i = 0; i < report.figures.size(); ++i) {
    const std::string& data = report.figures[i].data;
    if (i > 0) json += ',';
    json += data.empty() ? "null" : data;
  }
  return json + "],\"playback\":" + (report.playback ? playback_json(*report.playback) : "null") +
         "}";
}

}  // namespace

std::string to_html(const Report& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  html.append(kPolicy).append("\"/>\n<title>").append(escape_xml(report.title));
  html.append("</title>\n<style>\n").append(color_rules(report)).append(kPageStyle);
  html.append("</style>\n</head>\n<body>\n<main>\n");
  html += element("h1", report.title) + element("p", report.headline, "headline");
  html += facts_html(report.facts);
  for (const Figure& figure : report.figures) html += figure_html(figure);
  for (const Table& table : report.tables) html += table_html(table);
  html +=
      element("footer", report.origin) + "</main>\n<script type=\"application/json\" id=\"data\">";
  html.append(data_json(report)).append("</script>\n<script>\n");
  for (const std::string_view part :
       {kPageBase, kPageFigures, kPageCursor, kPageRobot, kPageEvents, kPageMoment}) {
    html.append(part);
  }
  return html + "</script>\n</body>\n</html>\n";
}

}  // namespace zonepack::report
