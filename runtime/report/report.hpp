// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/report/svg.hpp"

// A report: what is told in a sentence, in numbers, in figures and in tables; as a page or as a
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
};

struct TableColumn {
  std::string name;
  bool number = false;  // set to the right
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
  std::string origin;    // from what it was made; small print
  std::vector<Fact> facts;
  std::vector<Figure> figures;
  std::vector<Table> tables;
};

// A page that needs nothing else: no script, no outside resource; prints well.
std::string to_html(const Report& report);

// Everything on one sheet, top to bottom.
Svg to_sheet(const Report& report);

// Nothing for a name that write_report takes, else what is wrong with it: for checking usage.
std::optional<std::string> fault_of_report_name(const std::string& path);

// Writes .html, .svg or .png (drawn by rsvg-convert), whole or not at all. Returns nothing when
// written, else a complete message for the user.
std::optional<std::string> write_report(const std::string& path, const Report& report);

}  // namespace zonepack::report
