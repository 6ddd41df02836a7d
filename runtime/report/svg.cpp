// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/svg.hpp"

#include <algorithm>
#include <cmath>

#include "platform/base/base64.hpp"
#include "platform/base/require.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::report {
namespace {

constexpr double kFarthest = 1e6;

std::string number(double value) {
  return format_number(std::clamp(value, -kFarthest, kFarthest), 2);
}

bool is_finite(Px p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

std::string attribute(std::string_view name, std::string_view value) {
  std::string text = " ";
  return text.append(name).append("=\"").append(value).append("\"");
}

std::string attribute(std::string_view name, double value) {
  return attribute(name, std::string_view(number(value)));
}

std::string point_list(std::span<const Px> points, std::string_view first, std::string_view next) {
  std::string text;
  for (const Px& p : points) {
    if (!is_finite(p)) continue;
    text.append(text.empty() ? first : next).append(number(p.x)).append(",").append(number(p.y));
  }
  return text;
}

std::string hint_text(std::string_view hint) {
  if (hint.empty()) return {};
  std::string text = "<title>";
  return text.append(escape_xml(hint)).append("</title>");
}

}  // namespace

void Svg::shape(std::string_view name, std::string_view attributes, const Style& style) {
  body_.append("<").append(name).append(attributes);
  body_ += attribute("fill", style.fill ? to_hex(*style.fill) : "none");
  if (style.fill) colors_.insert(*style.fill);
  if (style.stroke) colors_.insert(*style.stroke);
  if (style.stroke) {
    body_ += attribute("stroke", to_hex(*style.stroke));
    if (style.stroke_width != 1) body_ += attribute("stroke-width", style.stroke_width);
    if (!style.dash.empty()) body_ += attribute("stroke-dasharray", style.dash);
    if (style.round) {
      body_ += attribute("stroke-linecap", "round") + attribute("stroke-linejoin", "round");
    }
  }
  if (style.opacity < 1) body_ += attribute("opacity", style.opacity);
  if (style.zone) body_ += attribute("data-zone", std::to_string(*style.zone));
  if (style.moment_s) {
    body_ += attribute("data-t", std::to_string(std::llround(*style.moment_s * 1000)));
  }
  if (style.hint.empty()) {
    body_ += "/>\n";
  } else {
    body_.append(">").append(hint_text(style.hint)).append("</").append(name).append(">\n");
  }
}

void Svg::line(Px from, Px to, const Style& style) {
  if (!is_finite(from) || !is_finite(to)) return;
  shape("line",
        attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
            attribute("y2", to.y),
        style);
}

void Svg::polyline(std::span<const Px> points, const Style& style) {
  const std::string list = point_list(points, "", " ");
  if (!list.empty()) shape("polyline", attribute("points", list), style);
}

void Svg::polygon(std::span<const std::vector<Px>> rings, const Style& style) {
  std::string path;
  for (const std::vector<Px>& ring : rings) {
    const std::string list = point_list(ring, "M", "L");
    if (!list.empty()) path += list + "Z";
  }
  if (!path.empty()) shape("path", attribute("fill-rule", "evenodd") + attribute("d", path), style);
}

void Svg::rect(Px corner, double width, double height, const Style& style, double radius) {
  if (!is_finite(corner) || !(width >= 0) || !(height >= 0)) return;
  std::string attributes = attribute("x", corner.x) + attribute("y", corner.y) +
                           attribute("width", width) + attribute("height", height);
  if (radius > 0) attributes += attribute("rx", radius);
  shape("rect", attributes, style);
}

void Svg::circle(Px center, double radius, const Style& style) {
  if (!is_finite(center) || !(radius >= 0)) return;
  shape("circle", attribute("cx", center.x) + attribute("cy", center.y) + attribute("r", radius),
        style);
}

void Svg::text(Px baseline, std::string_view text, const TextStyle& style) {
  if (!is_finite(baseline) || text.empty()) return;
  body_ += "<text";
  body_ += attribute("x", baseline.x) + attribute("y", baseline.y) +
           attribute("font-size", style.size) + attribute("fill", to_hex(style.color));
  if (style.on_color) {
    body_ += attribute("class", "on");
  } else {
    colors_.insert(style.color);
  }
  if (style.halo) colors_.insert(*style.halo);
  if (style.bold) body_ += attribute("font-weight", "bold");
  if (style.anchor != Anchor::kStart) {
    body_ += attribute("text-anchor", style.anchor == Anchor::kMiddle ? "middle" : "end");
  }
  if (style.halo) {
    body_ += attribute("stroke", to_hex(*style.halo)) + attribute("stroke-width", 3) +
             attribute("stroke-linejoin", "round") + attribute("paint-order", "stroke");
  }
  if (style.opacity < 1) body_ += attribute("opacity", style.opacity);
  body_.append(">").append(escape_xml(text)).append("</text>\n");
}

void Svg::image(Px corner, double width, double height, bool turned, std::string_view png,
                bool ground) {
  if (!is_finite(corner)) return;
  body_ += "<image";
  if (ground) body_ += attribute("class", "ground");
  if (turned) {
    const std::string right = number(corner.x + height), down = number(corner.y);
    body_.append(" transform=\"matrix(0 1 -1 0 ")
        .append(right)
        .append(" ")
        .append(down)
        .append(")\"");
    corner = {0, 0};
  }
  body_ += attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", width) +
           attribute("height", height) + attribute("preserveAspectRatio", "none") +
           attribute("pointer-events", "none") + " href=\"data:image/png;base64,";
  append_base64(std::as_bytes(std::span(png)), body_);
  body_ += "\"/>\n";
}

void Svg::open_clip(Px corner, double width, double height) {
  const std::string box =
      number(corner.x) + " " + number(corner.y) + " " + number(width) + " " + number(height);
  body_ += "<svg";
  body_ += attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", width) +
           attribute("height", height) + attribute("viewBox", box) +
           attribute("overflow", "hidden") + ">\n";
  open_.push_back("</svg>\n");
}

void Svg::open_group(std::string_view hint) {
  body_.append("<g>").append(hint_text(hint)).append("\n");
  open_.push_back("</g>\n");
}

void Svg::close() {
  ZP_REQUIRE(!open_.empty());
  body_ += open_.back();
  open_.pop_back();
}

void Svg::place(const Svg& drawing, Px corner) {
  ZP_REQUIRE(drawing.open_.empty());
  body_ += "<svg";
  body_ += attribute("x", corner.x) + attribute("y", corner.y) +
           attribute("width", drawing.width_) + attribute("height", drawing.height_) + ">\n" +
           drawing.body_ + "</svg>\n";
  colors_.insert(drawing.colors_.begin(), drawing.colors_.end());
}

void Svg::set_data(std::string_view name, std::string_view value) {
  data_ += attribute(std::string("data-").append(name), escape_xml(value));
}

std::string Svg::inline_text() const { return document(data_); }

std::string Svg::document(std::string_view data) const {
  ZP_REQUIRE(open_.empty());
  const std::string width = number(width_), height = number(height_);
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\"";
  text += attribute("width", width) + attribute("height", height);
  text.append(" viewBox=\"0 0 ").append(width).append(" ").append(height).append("\"");
  text += attribute("font-family", "DejaVu Sans, Verdana, sans-serif");
  return text.append(data).append(">\n").append(body_).append("</svg>\n");
}

std::string Svg::file_text() const {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  return text.append(document({}));
}

}  // namespace zonepack::report
