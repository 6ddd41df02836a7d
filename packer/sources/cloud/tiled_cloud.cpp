// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/tiled_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>

#include "packer/sources/cloud/pcd_stream.hpp"
#include "packer/sources/cloud/spool.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kMostTiles = 1'000'000;
constexpr std::size_t kPointsAtOnce = 256U << 10;

using Words = std::array<std::uint32_t, 6>;  // x, y, z, then what fields there are

struct Key {
  std::int64_t x, y;
  std::uint32_t zone;
  bool operator<(const Key& other) const {
    return std::tie(x, y, zone) < std::tie(other.x, other.y, other.zone);
  }
};

struct TileDraft {
  std::size_t index = 0;  // of the tile, in order of the key
  std::uint64_t points = 0, first = 0, filled = 0;
  std::array<double, 3> sum{};
  double nearest = std::numeric_limits<double>::max();
  std::array<double, 3> base{}, origin{};
};

class TiledCloud : public CloudMap {
 public:
  explicit TiledCloud(const SourceOptions& options)
      : name_(options.name()), options_(options), spool_(open_spool()) {
    bytes_ = std::filesystem::file_size(options.path);
    written_ = std::filesystem::last_write_time(options.path);
    count();
    distribute();
    describe();
    drafts_.clear();
  }

  void require_unchanged() const override {
    std::error_code error;
    const bool same = std::filesystem::file_size(options_.path, error) == bytes_ &&
                      std::filesystem::last_write_time(options_.path, error) == written_;
    if (!same || error) throw std::runtime_error(name_ + ": changed while it was read; try again");
  }

  void read(const CloudTile& tile, TilePoints& into) const override {
    into.clear();
    const std::size_t words = fields.words();
    std::vector<std::uint32_t> block(static_cast<std::size_t>(tile.points) * words);
    read_at(spool_.get(), places_[static_cast<std::size_t>(tile.id - 1)] * words * 4, block.data(),
            block.size() * 4, name_);
    for (std::size_t i = 0; i < block.size(); i += words) {
      std::size_t at = i;
      const auto number = [&] { return std::bit_cast<float>(block[at++]); };
      into.x.push_back(number());
      into.y.push_back(number());
      into.z.push_back(number());
      if (fields.intensity) into.intensity.push_back(number());
      if (fields.rgb) into.rgb.push_back(block[at++]);
      if (fields.ring) into.ring.push_back(number());
    }
  }

 private:
  Key key_of(const CloudPoint& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / options_.tile_m)),
            static_cast<std::int64_t>(std::floor(p.y / options_.tile_m)),
            options_.zone_at ? options_.zone_at(p.x, p.y, p.z) : 0U};
  }

  // How many points each tile has, and where their middle is.
  void count() {
    const auto stream = open_pcd(name_);
    fields = stream->fields();
    std::uint64_t nowhere = 0;
    for (CloudPoint p; stream->next(p);) {
      if (!is_place(p)) {
        ++nowhere;
        continue;
      }
      TileDraft& draft = drafts_[key_of(p)];
      if (drafts_.size() > kMostTiles) {
        throw std::runtime_error(name_ +
                                 ": would be cut into more than 1,000,000 tiles; give a "
                                 "larger --tile METRES");
      }
      ++draft.points;
      draft.sum[0] += p.x;
      draft.sum[1] += p.y;
      draft.sum[2] += p.z;
      ++points;
    }
    if (nowhere > 0) {
      warnings.push_back(name_ + ": " + std::to_string(nowhere) + " of " +
                         std::to_string(points + nowhere) +
                         " points are not finite or over 10,000 km away; they are left out");
    }
    std::uint64_t first = 0;
    std::size_t index = 0;
    for (auto& [key, draft] : drafts_) {
      draft.index = index++;
      draft.first = first;
      first += draft.points;
      if (fields.wide) {  // the corner of the tile, which float32 holds exactly enough
        draft.origin = {
            static_cast<float>(static_cast<double>(key.x) * options_.tile_m),
            static_cast<float>(static_cast<double>(key.y) * options_.tile_m),
            static_cast<float>(std::floor(draft.sum[2] / static_cast<double>(draft.points)))};
      }
    }
  }

  // The points into the temporary file, those of a tile next to each other.
  void distribute() {
    const auto stream = open_pcd(name_);
    const std::size_t words = fields.words();
    std::vector<std::pair<TileDraft*, Words>> held;
    held.reserve(kPointsAtOnce);
    const auto flush = [&] {
      std::ranges::stable_sort(held, {}, [](const auto& one) { return one.first->index; });
      std::vector<std::uint32_t> run;
      for (std::size_t i = 0; i < held.size();) {
        TileDraft& draft = *held[i].first;
        run.clear();
        std::size_t end = i;
        for (; end < held.size() && held[end].first == &draft; ++end) {
          run.insert(run.end(), held[end].second.begin(),
                     held[end].second.begin() + static_cast<std::ptrdiff_t>(words));
        }
        if (draft.filled + (end - i) > draft.points) fail_changed();
        write_at(spool_.get(), (draft.first + draft.filled) * words * 4, run.data(),
                 run.size() * 4);
        draft.filled += end - i;
        i = end;
      }
      held.clear();
    };
    for (CloudPoint p; stream->next(p);) {
      if (!is_place(p)) continue;
      const auto found = drafts_.find(key_of(p));
      if (found == drafts_.end()) fail_changed();
      TileDraft& draft = found->second;
      note_nearest(p, draft);
      held.emplace_back(&draft, words_of(p, draft));
      if (held.size() == kPointsAtOnce) flush();
    }
    flush();
    for (const auto& [key, draft] : drafts_) {
      if (draft.filled != draft.points) fail_changed();
    }
  }

  [[noreturn]] void fail_changed() const {
    throw std::runtime_error(name_ + ": changed while it was read; try again");
  }

  static void note_nearest(const CloudPoint& p, TileDraft& draft) {
    const auto n = static_cast<double>(draft.points);
    const double dx = p.x - draft.sum[0] / n, dy = p.y - draft.sum[1] / n,
                 dz = p.z - draft.sum[2] / n;
    const double square = dx * dx + dy * dy + dz * dz;
    if (square >= draft.nearest) return;
    draft.nearest = square;
    draft.base = {p.x, p.y, p.z};
  }

  Words words_of(const CloudPoint& p, const TileDraft& draft) const {
    Words out{};
    std::size_t at = 0;
    const auto put = [&](double value) {
      out[at++] = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    };
    put(p.x - draft.origin[0]);
    put(p.y - draft.origin[1]);
    put(p.z - draft.origin[2]);
    if (fields.intensity) put(p.intensity);
    if (fields.rgb) out[at++] = p.rgb;
    if (fields.ring) put(p.ring);
    return out;
  }

  void describe() {
    version = "pcd";
    for (const auto& entry : drafts_) {
      const TileDraft& draft = entry.second;
      CloudTile& tile = tiles.emplace_back();
      tile.id = static_cast<std::int32_t>(tiles.size());
      tile.points = draft.points;
      tile.base = draft.base;
      const auto b = [&draft](std::size_t i) { return static_cast<float>(draft.base[i]); };
      tile.T_map_base = {1, 0, 0, b(0), 0, 1, 0, b(1), 0, 0, 1, b(2)};
      const auto o = [&draft, b](std::size_t i) {
        return static_cast<float>(draft.origin[i] - static_cast<double>(b(i)));
      };
      tile.T_base_points = {1, 0, 0, o(0), 0, 1, 0, o(1), 0, 0, 1, o(2)};
      places_.push_back(draft.first);
    }
    source_bytes = points * fields.words() * 4;
    notes.push_back(std::to_string(points) + " points in " + std::to_string(tiles.size()) +
                    (tiles.size() == 1 ? " tile" : " tiles") + " of " + number(options_.tile_m) +
                    " m" + (options_.zone_at ? ", cut at the borders of zones" : ""));
    if (fields.wide) {
      warnings.push_back(name_ +
                         ": coordinates are float64; they are rounded to float32 from the "
                         "corner of their tile, which moves them by less than a micrometre "
                         "in tiles of up to 10 m");
    }
  }

  static std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  }

  std::string name_;
  SourceOptions options_;
  File spool_;
  std::uintmax_t bytes_ = 0;
  std::filesystem::file_time_type written_;
  std::map<Key, TileDraft> drafts_;
  std::vector<std::uint64_t> places_;  // by tile: its first point in the spool
};

}  // namespace

std::unique_ptr<CloudMap> open_tiled_cloud(const SourceOptions& options) {
  return std::make_unique<TiledCloud>(options);
}

}  // namespace zonepack::packer
