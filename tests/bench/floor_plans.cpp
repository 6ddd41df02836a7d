// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/floor_plans.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace zonepack::bench {
namespace {

using packer::suggest::CellIndex;

constexpr double kCell_m = 0.05, kModelCell_m = 0.025;

struct Rect {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
};

// A room is a rectangle between wall centres, or several (an L), or one with a corner cut off.
struct Room {
  std::vector<Rect> parts;
  bool corridor = false;
  double cut_corner_m = 0;  // of its lower left corner, by a slanted wall
};

struct Opening {
  std::size_t a = 0, b = 0;
  double x = 0, y = 0;  // its middle, on the wall
  double width = 0;
  bool along_x = false;  // the wall runs along x
  bool leaf = false;     // a door leaf stands open
};

class Architect {
 public:
  explicit Architect(const PlanRecipe& recipe)
      : recipe_(recipe), random_(recipe.seed * 7919 + 17) {}

  DrawnPlan run() {
    wall_m_ = between(0.1, 0.3);
    switch (recipe_.layout) {
      case PlanRecipe::Layout::kCorridor:
        corridor_building();
        break;
      case PlanRecipe::Layout::kLoop:
        loop_building();
        break;
      case PlanRecipe::Layout::kHouse:
        house();
        break;
      case PlanRecipe::Layout::kLobby:
        lobby_building();
        break;
    }
    shape_rooms();
    join_rooms();
    paint();
    return sample();
  }

 private:
  // std::uniform_*_distribution differ between libraries; this does not.
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) / 9007199254740992.0;
  }
  bool chance(double p) { return between(0, 1) < p; }

  void add(Rect rect, bool corridor = false) { rooms_.push_back({{rect}, corridor, 0}); }

  // A row of rooms side by side, along x from x0 to x1 (or along y, when `upright`).
  void row(Rect strip, bool upright) {
    const double from = upright ? strip.y0 : strip.x0, to = upright ? strip.y1 : strip.x1;
    double at = from;
    while (at < to - 0.01) {
      double next = at + (chance(0.15) ? between(1.5, 2.2) : between(2.6, 6.5));
      if (to - next < 2) next = to;
      Rect room = strip;
      (upright ? room.y0 : room.x0) = at;
      (upright ? room.y1 : room.x1) = next;
      const double wide = upright ? room.height() : room.width();
      const double deep = upright ? room.width() : room.height();
      if (deep > 4 && wide > 3 && chance(0.2)) {  // a room behind a room
        Rect back = room;
        const double cut = between(0.4, 0.6);
        if (upright) {
          back.x0 = room.x1 = room.x0 + cut * room.width();
        } else {
          back.y0 = room.y1 = room.y0 + cut * room.height();
        }
        add(back);
      }
      add(room);
      at = next;
    }
  }

  void corridor_building() {
    const double length = between(18, 45), corridor = between(1.4, 2.8);
    const double low = between(3, 6), high = between(3, 6);
    size_x_ = length;
    size_y_ = low + corridor + high;
    row({0, 0, length, low}, false);
    add({0, low, length, low + corridor}, true);
    row({0, low + corridor, length, size_y_}, false);
    if (chance(0.6)) {  // a wing upwards, from the corridor through the upper row
      const double x = between(0.3, 0.6) * length, wing = between(8, 16);
      const double y = low + corridor, side = between(3, 5);
      rooms_.erase(std::remove_if(rooms_.begin(), rooms_.end(),
                                  [&](const Room& room) {
                                    const Rect& r = room.parts[0];
                                    return r.y0 >= y - 0.01 && r.x1 > x && r.x0 < x + corridor;
                                  }),
                   rooms_.end());
      for (Room& room : rooms_) {
        if (room.corridor) room.parts.push_back({x, y, x + corridor, size_y_ + wing});
      }
      row({x - side, size_y_, x, size_y_ + wing}, true);
      row({x + corridor, size_y_, x + corridor + side, size_y_ + wing}, true);
      size_y_ += wing;
      size_x_ = std::max(size_x_, x + corridor + side);
    }
  }

  void loop_building() {
    const double corridor = between(1.5, 2.5), outer = between(3.5, 5.5);
    const double core_x = between(8, 20), core_y = between(4, 9);
    const double ring_x = core_x + 2 * corridor, ring_y = core_y + 2 * corridor;
    size_x_ = ring_x + 2 * outer;
    size_y_ = ring_y + 2 * outer;
    const double x = outer + corridor, y = outer + corridor;
    row({0, 0, size_x_, outer}, false);
    row({0, size_y_ - outer, size_x_, size_y_}, false);
    row({0, outer, outer, size_y_ - outer}, true);
    row({size_x_ - outer, outer, size_x_, size_y_ - outer}, true);
    row({x, y, x + core_x, y + core_y}, false);
    rooms_.push_back({{{outer, outer, outer + ring_x, y},
                       {outer, y + core_y, outer + ring_x, y + core_y + corridor},
                       {outer, y, x, y + core_y},
                       {x + core_x, y, x + core_x + corridor, y + core_y}},
                      true,
                      0});
  }

  void split(Rect rect) {
    const double area = rect.width() * rect.height();
    const double longer = std::max(rect.width(), rect.height());
    if (longer < 4.5 || (area < 30 && chance(0.5)) || area < 12) return add(rect);
    Rect other = rect;
    const double cut = between(0.35, 0.65);
    if (rect.width() > rect.height()) {
      rect.x1 = other.x0 = rect.x0 + cut * rect.width();
    } else {
      rect.y1 = other.y0 = rect.y0 + cut * rect.height();
    }
    split(rect);
    split(other);
  }

  void house() {
    size_x_ = between(10, 22);
    size_y_ = between(8, 16);
    split({0, 0, size_x_, size_y_});
  }

  void lobby_building() {
    const double lobby_x = between(7, 12), lobby_y = between(8, 14), wing = between(12, 24);
    const double corridor = between(1.6, 2.8), low = (lobby_y - corridor) / 2;
    size_x_ = lobby_x + wing;
    size_y_ = lobby_y;
    add({0, 0, lobby_x, lobby_y});
    lobby_ = 0;
    add({lobby_x, low, size_x_, low + corridor}, true);
    row({lobby_x, 0, size_x_, low}, false);
    row({lobby_x, low + corridor, size_x_, lobby_y}, false);
    for (double px = 2.5; px < lobby_x - 2; px += 3) pillars_.push_back({px, lobby_y / 2});
  }

  void shape_rooms() {
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      const Rect r = rooms_[i].parts[0];
      if (rooms_[i].corridor || rooms_[i].parts.size() > 1) continue;
      if (r.width() > 4 && r.height() > 4 && chance(0.25)) {  // an L around a small room
        const double w = between(1.6, r.width() / 2), h = between(1.6, r.height() / 2);
        rooms_[i].parts = {{r.x0, r.y0, r.x1 - w, r.y1}, {r.x1 - w, r.y0, r.x1, r.y1 - h}};
        add({r.x1 - w, r.y1 - h, r.x1, r.y1});
      } else if (r.width() > 3.5 && r.height() > 3.5 && chance(0.15)) {
        rooms_[i].cut_corner_m = between(0.8, 1.6);
      }
    }
  }

  // The stretch of wall that two rooms share: of all, the longest.
  bool shared_wall(const Room& a, const Room& b, Rect& wall) const {
    double longest = 0;
    for (const Rect& r : a.parts) {
      for (const Rect& s : b.parts) {
        const double x0 = std::max(r.x0, s.x0), x1 = std::min(r.x1, s.x1);
        const double y0 = std::max(r.y0, s.y0), y1 = std::min(r.y1, s.y1);
        if (x1 - x0 < -0.001 || y1 - y0 < -0.001) continue;
        const double length = std::max(x1 - x0, y1 - y0);
        if (length <= longest) continue;
        longest = length;
        wall = {x0, y0, x1, y1};
      }
    }
    return longest > 0;
  }

  void open(std::size_t a, std::size_t b, const Rect& wall) {
    const bool along_x = wall.width() > wall.height();
    const double length = std::max(wall.width(), wall.height());
    Opening opening{.a = a,
                    .b = b,
                    .width = std::min(between(0.7, 1.2), length - wall_m_ - 0.2),
                    .along_x = along_x,
                    .leaf = chance(0.5)};
    const bool big =
        recipe_.layout == PlanRecipe::Layout::kLobby && lobby_ == a && rooms_[b].corridor;
    if (big) {  // the corridor ends in the lobby, as wide as it is
      opening.width = length - wall_m_;
      opening.leaf = false;
    }
    const double room = length - opening.width - wall_m_;
    const double at = wall_m_ / 2 + opening.width / 2 +
                      (big           ? 0
                       : chance(0.5) ? std::min(0.15, room)
                                     : between(0, 1) * room);
    opening.x = along_x ? wall.x0 + at : wall.x0;
    opening.y = along_x ? wall.y0 : wall.y0 + at;
    openings_.push_back(opening);
  }

  // Every room gets a door to the corridor or, behind another room, to that; some get a second.
  void join_rooms() {
    std::vector<std::size_t> group(rooms_.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (group[i] != i) i = group[i];
      return i;
    };
    for (const bool to_corridor : {true, false}) {
      for (std::size_t i = 0; i < rooms_.size(); ++i) {
        for (std::size_t j = i + 1; j < rooms_.size(); ++j) {
          const bool corridor = rooms_[i].corridor || rooms_[j].corridor;
          Rect wall;
          if (!shared_wall(rooms_[i], rooms_[j], wall)) continue;
          if (std::max(wall.width(), wall.height()) < 0.8 + wall_m_ + 0.2) continue;
          if (corridor != to_corridor) continue;
          if (root(i) == root(j) && (corridor || !chance(0.06))) continue;
          group[root(j)] = root(i);
          open(i, j, wall);
        }
      }
    }
    // What is still alone stays a closed room.
  }

  // The model: a raster of 2.5 cm. -1 wall.
  std::int32_t& model(int column, int row) {
    return model_[static_cast<std::size_t>(row * columns_ + column)];
  }
  void fill(Rect rect, std::int32_t room) {
    const auto cell = [](double v) { return static_cast<int>(std::lround(v / kModelCell_m)); };
    for (int y = std::max(cell(rect.y0 + 1), 0); y < std::min(cell(rect.y1 + 1), rows_); ++y) {
      for (int x = std::max(cell(rect.x0 + 1), 0); x < std::min(cell(rect.x1 + 1), columns_); ++x) {
        model(x, y) = room;
      }
    }
  }

  void paint() {
    columns_ = static_cast<int>((size_x_ + 2) / kModelCell_m);
    rows_ = static_cast<int>((size_y_ + 2) / kModelCell_m);
    model_.assign(static_cast<std::size_t>(columns_ * rows_), -1);
    const double half = wall_m_ / 2;
    for (std::size_t i = 0; i < rooms_.size(); ++i) {
      for (const Rect& r : rooms_[i].parts) {
        fill({r.x0 + half, r.y0 + half, r.x1 - half, r.y1 - half}, static_cast<std::int32_t>(i));
      }
      join_parts(rooms_[i], static_cast<std::int32_t>(i));
      cut_corner(rooms_[i]);
    }
    for (const auto& [x, y] : pillars_) fill({x - 0.2, y - 0.2, x + 0.2, y + 0.2}, -1);
    if (recipe_.furnished) {
      for (std::size_t i = 0; i < rooms_.size(); ++i) furnish(i);
    }
    for (const Opening& o : openings_) {
      const auto a = static_cast<std::int32_t>(o.a), b = static_cast<std::int32_t>(o.b);
      const double w = o.width / 2, deep = half + 0.03;
      // Which room is on which side is read from the model.
      for (const double side : {-1.0, 1.0}) {
        const double px = o.along_x ? o.x : o.x + side * (half + 0.2);
        const double py = o.along_x ? o.y + side * (half + 0.2) : o.y;
        const std::int32_t found = at(px, py);
        const std::int32_t room = found == a || found == b ? found : side < 0 ? a : b;
        if (o.along_x) {
          fill({o.x - w, std::min(o.y, o.y + side * deep), o.x + w,
                std::max(o.y, o.y + side * deep)},
               room);
        } else {
          fill({std::min(o.x, o.x + side * deep), o.y - w, std::max(o.x, o.x + side * deep),
                o.y + w},
               room);
        }
      }
      if (o.leaf && recipe_.scanned) {  // open by 90 degrees, never into a corridor
        const std::int32_t above =
            o.along_x ? at(o.x, o.y + half + 0.2) : at(o.x + half + 0.2, o.y);
        const bool up = above >= 0 && !rooms_[static_cast<std::size_t>(above)].corridor;
        const double from = up ? half : -half - o.width, to = up ? half + o.width : -half;
        if (o.along_x) {
          fill({o.x - w - 0.05, o.y + from, o.x - w, o.y + to}, -1);
        } else {
          fill({o.x + from, o.y - w - 0.05, o.x + to, o.y - w}, -1);
        }
      }
    }
  }

  std::int32_t at(double x, double y) {
    const auto column = static_cast<int>((x + 1) / kModelCell_m);
    const auto row = static_cast<int>((y + 1) / kModelCell_m);
    return column < 0 || row < 0 || column >= columns_ || row >= rows_ ? -1 : model(column, row);
  }

  void join_parts(const Room& room, std::int32_t id) {
    const double half = wall_m_ / 2;
    for (std::size_t i = 0; i < room.parts.size(); ++i) {
      for (std::size_t j = i + 1; j < room.parts.size(); ++j) {
        const Rect &r = room.parts[i], &s = room.parts[j];
        const double x0 = std::max(r.x0, s.x0), x1 = std::min(r.x1, s.x1);
        const double y0 = std::max(r.y0, s.y0), y1 = std::min(r.y1, s.y1);
        if (x1 - x0 > 0.5 && std::abs(y1 - y0) < 0.01) {
          fill({x0 + half, y0 - half, x1 - half, y0 + half}, id);
        } else if (y1 - y0 > 0.5 && std::abs(x1 - x0) < 0.01) {
          fill({x0 - half, y0 + half, x0 + half, y1 - half}, id);
        }
      }
    }
  }

  void cut_corner(const Room& room) {
    const Rect& r = room.parts[0];
    for (double d = 0; d < room.cut_corner_m; d += kModelCell_m) {
      fill({r.x0, r.y0 + d, r.x0 + room.cut_corner_m - d + wall_m_ / 2,
            r.y0 + d + kModelCell_m + wall_m_ / 2},
           -1);
    }
  }

  void furnish(std::size_t i) {
    const Room& room = rooms_[i];
    const Rect r = room.parts[0];
    const double half = wall_m_ / 2;
    const auto place = [&](double x, double y, double w, double h) {
      const Rect piece{x, y, x + w, y + h};
      for (const Opening& o : openings_) {  // a door can be walked through
        if (o.a != i && o.b != i) continue;
        const double reach = o.width / 2 + 0.5;
        if (piece.x0 < o.x + reach && piece.x1 > o.x - reach && piece.y0 < o.y + reach &&
            piece.y1 > o.y - reach) {
          return;
        }
      }
      if (piece.x0 < r.x0 + half || piece.y0 < r.y0 + half || piece.x1 > r.x1 - half ||
          piece.y1 > r.y1 - half) {
        return;
      }
      fill(piece, -1);
    };
    if (room.corridor) {
      for (int k = 0; k < 3; ++k) {
        place(between(r.x0, r.x1), r.y0 + half, between(0.5, 1.5), 0.35);
      }
      return;
    }
    if (r.width() * r.height() < 5) return;
    const auto pieces = static_cast<int>(r.width() * r.height() / 6) + 1;
    for (int k = 0; k < pieces; ++k) {
      const double x = between(r.x0, r.x1), y = between(r.y0, r.y1);
      switch (static_cast<int>(between(0, 5))) {
        case 0:  // a shelf along a wall
          place(x, r.y0 + half, between(0.8, 2.4), 0.4);
          break;
        case 1:
          place(r.x1 - half - 0.4, y, 0.4, between(0.8, 2.4));
          break;
        case 2:  // a bed, its head to a wall
          place(x, r.y1 - half - 2, 0.95, 2);
          break;
        case 3:  // a desk at a wall, a chair
          place(r.x0 + half, y, 0.8, 1.6);
          place(r.x0 + half + 1, y + 0.5, 0.45, 0.45);
          break;
        default:  // a table with chairs, standing free
          place(x, y, 1.6, 0.8);
          place(x + 0.2, y + 0.9, 0.45, 0.45);
          place(x + 0.9, y - 0.55, 0.45, 0.45);
      }
    }
  }

  DrawnPlan sample() {
    const double c = std::cos(recipe_.turned_rad), s = std::sin(recipe_.turned_rad);
    const double wide = (size_x_ + 2) * std::abs(c) + (size_y_ + 2) * std::abs(s);
    const double high = (size_x_ + 2) * std::abs(s) + (size_y_ + 2) * std::abs(c);
    DrawnPlan plan;
    plan.space.cell_m = kCell_m;
    plan.space.columns = static_cast<std::int32_t>(wide / kCell_m) + 2;
    plan.space.rows = static_cast<std::int32_t>(high / kCell_m) + 2;
    const auto size =
        static_cast<std::size_t>(plan.space.columns) * static_cast<std::size_t>(plan.space.rows);
    plan.space.free.resize(size);
    plan.room_of.assign(size, -1);
    for (std::int32_t row = 1; row + 1 < plan.space.rows; ++row) {
      for (std::int32_t column = 1; column + 1 < plan.space.columns; ++column) {
        const double u = (column + 0.5) * kCell_m - wide / 2, v = (row + 0.5) * kCell_m - high / 2;
        const double x = c * u + s * v + size_x_ / 2, y = c * v - s * u + size_y_ / 2;
        const auto cell = static_cast<std::size_t>(plan.space.at(column, row));
        // A laser's ranges are a few centimetres off.
        const double off = recipe_.scanned ? 0.03 : 0;
        plan.room_of[cell] = at(x + between(-off, off), y + between(-off, off));
        if (recipe_.scanned && chance(0.0005)) plan.room_of[cell] = -1;
        plan.space.free[cell] = plan.room_of[cell] >= 0 ? 1 : 0;
      }
    }
    std::vector<bool> seen(rooms_.size());
    for (const std::int32_t room : plan.room_of) {
      if (room >= 0) seen[static_cast<std::size_t>(room)] = true;
    }
    plan.rooms = static_cast<std::int32_t>(std::count(seen.begin(), seen.end(), true));
    return plan;
  }

  const PlanRecipe recipe_;
  std::mt19937_64 random_;
  double wall_m_ = 0, size_x_ = 0, size_y_ = 0;
  std::vector<Room> rooms_;
  std::size_t lobby_ = SIZE_MAX;
  std::vector<std::pair<double, double>> pillars_;
  std::vector<Opening> openings_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> model_;
};

}  // namespace

DrawnPlan draw_plan(const PlanRecipe& recipe) { return Architect(recipe).run(); }

std::string name_of(const PlanRecipe& recipe) {
  static constexpr const char* kNames[] = {"corridor", "loop", "house", "lobby"};
  return std::string(kNames[static_cast<int>(recipe.layout)]) + (recipe.scanned ? " scanned" : "") +
         (recipe.furnished ? " furnished" : "") + (recipe.turned_rad != 0 ? " turned" : "");
}

}  // namespace zonepack::bench
