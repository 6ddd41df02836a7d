// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/report/playback.hpp"
#include "runtime/report/svg.hpp"

// A report: a result in one sentence, in numbers, in figures and in tables; as a page or as a
// picture.
namespace zonepack::report {

struct Fact {
  std::string name, value;
  std::string note;  // what it means, in a few words; may be empty
  bool bad = false;  // drawn as a warning
};

struct Figure {
  std::string title;
  std::string caption;  // how to read it
  Svg drawing;
  std::optional<Svg> narrow = {};  // the same for a page as narrow as a phone's
  std::string data = {};           // chart_json() or plan_json(), for the page's script
};

struct TableColumn {
  std::string name;
  bool number = false;  // aligned to the right
};

struct Table {
  std::string title;
  std::string caption;
  std::vector<TableColumn> columns;
  std::vector<std::vector<std::string>> rows;  // as many cells as columns
};

struct Report {
  std::string title;
  std::string headline;  // the result in one sentence
  std::string origin;    // what it was made from; small print
  std::vector<Fact> facts;
  std::vector<Figure> figures;
  std::vector<Table> tables;
  std::optional<Playback> playback = {};  // on the first figure
};

// A page that needs nothing else, prints well, fits a phone and follows the reader's choice of a
// light or dark page. It shows everything without its script (page/), which adds values under
// the cursor, playing the run, the list of events and tables in another order.
std::string to_html(const Report& report);

// Everything on one sheet, top to bottom.
Svg to_sheet(const Report& report);

// Whether write_report() takes this name; else kUsage.
Outcome<void> check_report_name(const std::string& path);

// Writes .html, .svg or .png (drawn by rsvg-convert), whole or not at all.
Outcome<void> write_report(const std::string& path, const Report& report);

}  // namespace zonepack::report
