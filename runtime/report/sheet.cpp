// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "runtime/report/format.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::report {
namespace {

constexpr double kWidth = 940, kMargin = 20, kInner = kWidth - 2 * kMargin;
constexpr double kFactHeight = 52, kRowHeight = 19, kCellGap = 18, kCellSize = 11;
constexpr std::size_t kFactsARow = 4;

// Draws from top to bottom; `y` is the top of the next item. Without a drawing it only measures.
struct Sheet {
  Svg* svg;
  double y = kMargin;

  void paragraph(std::string_view text, const TextStyle& style, double after) {
    for (const std::string& line : wrap_text(text, kInner / style.size * (style.bold ? 0.88 : 1))) {
      y += style.size * 1.35;
      if (svg != nullptr) svg->text({kMargin, y - style.size * 0.3}, line, style);
    }
    if (!text.empty()) y += after;
  }

  void facts(const std::vector<Fact>& all) {
    const double width = kInner / static_cast<double>(kFactsARow);
    for (std::size_t i = 0; i < all.size() && svg != nullptr; ++i) {
      const std::size_t row = i / kFactsARow;
      const Px at{kMargin + width * static_cast<double>(i % kFactsARow),
                  y + kFactHeight * static_cast<double>(row)};
      svg->line(at, {at.x + width - 14, at.y}, {.stroke = kFaint});
      svg->text({at.x, at.y + 15}, all[i].name, {.size = 11, .color = kQuiet});
      svg->text({at.x, at.y + 33}, all[i].value,
                {.size = 15, .color = all[i].bad ? kLimit : kInk, .bold = true});
      svg->text({at.x, at.y + 46}, all[i].note, {.size = 9.5, .color = kQuiet});
    }
    const std::size_t rows = (all.size() + kFactsARow - 1) / kFactsARow;
    y += kFactHeight * static_cast<double>(rows);
  }

  void heading(std::string_view text, std::string_view caption) {
    y += 16;
    paragraph(text, {.size = 15, .bold = true}, 2);
    paragraph(caption, {.size = 11, .color = kQuiet}, 8);
  }

  void figure(const Figure& figure) {
    heading(figure.title, figure.caption);
    if (svg != nullptr) svg->place(figure.drawing, {kMargin, y});
    y += figure.drawing.height();
  }

  void table(const Table& table) {
    heading(table.title, table.caption);
    const std::vector<double> widths = column_widths(table);
    const auto draw_row = [&](const auto& text_of, bool bold) {
      double x = kMargin;
      y += kRowHeight;
      for (std::size_t c = 0; c < widths.size(); ++c) {
        const bool number = table.columns[c].number;
        if (svg != nullptr) {
          svg->text(
              {number ? x + widths[c] : x, y - 6},
              shorten_text(text_of(c), widths[c] / kCellSize + 0.1),
              {.size = kCellSize, .bold = bold, .anchor = number ? Anchor::kEnd : Anchor::kStart});
        }
        x += widths[c] + kCellGap;
      }
      if (svg != nullptr) {
        svg->line({kMargin, y}, {x - kCellGap, y}, {.stroke = bold ? kWall : kFaint});
      }
    };
    draw_row([&](std::size_t c) { return table.columns[c].name; }, true);
    for (const auto& row : table.rows) {
      draw_row([&](std::size_t c) { return c < row.size() ? row[c] : std::string(); }, false);
    }
  }

  // As wide as their text; when the sum is too large, the widest column shrinks.
  static std::vector<double> column_widths(const Table& table) {
    std::vector<double> widths;
    double total = 0;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      double width = text_width_em(table.columns[c].name, true);
      for (const auto& row : table.rows) {
        if (c < row.size()) width = std::max(width, text_width_em(row[c]));
      }
      widths.push_back(width * kCellSize);
      total += widths.back() + kCellGap;
    }
    if (total - kCellGap > kInner) {
      double& widest = *std::ranges::max_element(widths);
      widest = std::max(widest - (total - kCellGap - kInner), 40.0);
    }
    return widths;
  }
};

double lay_out(const Report& report, Svg* svg) {
  Sheet sheet{svg};
  sheet.paragraph(report.title, {.size = 22, .bold = true}, 4);
  sheet.paragraph(report.headline, {.size = 15}, 12);
  sheet.facts(report.facts);
  for (const Figure& figure : report.figures) sheet.figure(figure);
  for (const Table& table : report.tables) sheet.table(table);
  sheet.y += 12;
  sheet.paragraph(report.origin, {.size = 10, .color = kQuiet}, 0);
  return sheet.y + kMargin;
}

}  // namespace

Svg to_sheet(const Report& report) {
  Svg svg(kWidth, lay_out(report, nullptr));
  svg.rect({0, 0}, svg.width(), svg.height(), {.fill = kWhite});
  lay_out(report, &svg);
  return svg;
}

}  // namespace zonepack::report
