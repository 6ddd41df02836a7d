// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/report/color.hpp"

namespace zonepack::report {

// A position on the page: pixels, x right, y down.
struct Px {
  double x = 0;
  double y = 0;
};

struct Style {
  std::optional<Color> fill = {};
  std::optional<Color> stroke = {};
  double stroke_width = 1;
  double opacity = 1;
  std::string_view dash = {};            // "4 3"
  bool round = false;                    // line ends and joins
  std::string_view hint = {};            // shown while the mouse is over the shape
  std::optional<std::size_t> zone = {};  // the shape is this zone's ground: data-zone, for a script
  std::optional<double> moment_s = {};   // of the run, when this was so: data-t, in milliseconds
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextStyle {
  double size = 12;
  Color color = kInk;
  bool bold = false;
  Anchor anchor = Anchor::kStart;
  std::optional<Color> halo = {};  // a border of this colour, to read on top of lines
  double opacity = 1;
  bool on_color = false;  // stands on a block of strong colour
};

// Writes one drawing as SVG 1.1 text: no script, style sheet, id or outside resource, so that any
// number of drawings can share a page. The same calls give the same bytes. Skips points that are
// not finite. Attributes that begin with data- are for the page's script.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  double width() const noexcept { return width_; }
  double height() const noexcept { return height_; }

  void line(Px from, Px to, const Style& style);
  void polyline(std::span<const Px> points, const Style& style);
  // Rings of one area; holes by the even-odd rule.
  void polygon(std::span<const std::vector<Px>> rings, const Style& style);
  void rect(Px corner, double width, double height, const Style& style, double radius = 0);
  void circle(Px center, double radius, const Style& style);
  void text(Px baseline, std::string_view text, const TextStyle& style);
  // A PNG file, held inside the drawing and stretched over the box that begins at `corner`. Turned:
  // its own right points down the page and its own up to the right, and `width` and `height` are
  // those of the picture before the turn.
  // `ground`: a picture in ink on a transparent page, whose lightness follows the page's.
  void image(Px corner, double width, double height, bool turned, std::string_view png,
             bool ground = false);

  // Until close(), clips everything to the box; coordinates stay those of the drawing.
  void open_clip(Px corner, double width, double height);
  void open_group(std::string_view hint = {});
  void close();

  // Inserts another drawing with its upper left corner here.
  void place(const Svg& drawing, Px corner);

  // An attribute data-`name` of the document on a page; `value` is plain text.
  void set_data(std::string_view name, std::string_view value);

  // What has been drawn with, but for text on blocks of colour.
  const std::set<Color>& colors() const noexcept { return colors_; }

  // The finished document, for a page or (with an XML declaration) for a file.
  std::string inline_text() const;
  std::string file_text() const;

 private:
  std::string document(std::string_view data) const;
  void shape(std::string_view name, std::string_view attributes, const Style& style);

  double width_;
  double height_;
  std::string body_;
  std::string data_;
  std::set<Color> colors_;
  std::vector<std::string_view> open_;
};

}  // namespace zonepack::report
