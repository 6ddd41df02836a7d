// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/floor_heights.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>

namespace zonepack::packer {
namespace {

constexpr double kLevel_m = 0.1;
constexpr std::int32_t kSide = 8;  // places of 0.25 m along a square
constexpr int kWidePlaces = 7;     // of a place and its eight neighbours
constexpr std::uint32_t kLeastPlaces = 32;
constexpr std::uint32_t kLeastOfSquare = 16;
constexpr std::int32_t kSlopeLevels = 2;
constexpr double kHeightSteps = 1024;

std::int32_t whole(double value) { return static_cast<std::int32_t>(std::floor(value)); }

std::int32_t place_along(double metres, std::int32_t square) {
  const double from = metres - square * kFloorSquare_m;
  return std::clamp(whole(from / kFloorSquare_m * kSide), 0, kSide - 1);
}

}  // namespace

FloorSquare floor_square_of(double x_m, double y_m) {
  return {whole(x_m / kFloorSquare_m), whole(y_m / kFloorSquare_m)};
}

std::optional<double> FloorHeights::at(const FloorSquare& square) const {
  const auto found = z_m.find(square);
  return found == z_m.end() ? std::nullopt : std::optional(found->second);
}

double FloorHeights::median_m() const {
  std::vector<double> heights;
  heights.reserve(z_m.size());
  for (const auto& [square, z] : z_m) heights.push_back(z);
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

std::size_t FloorFinder::KeyHash::operator()(const Key& key) const noexcept {
  const std::uint32_t level = static_cast<std::uint32_t>(key.level) * 0x85EBCA6BU;
  return FloorSquareHash{}(key.square) ^ level;
}

void FloorFinder::add(double x_m, double y_m, double z_m) {
  const FloorSquare square = floor_square_of(x_m, y_m);
  const Key key{square, whole(z_m / kLevel_m)};
  if (levels_.size() > kMostLevels) return;
  if (last_ == nullptr || !(key == last_key_)) {
    last_ = &levels_[key];
    last_key_ = key;
  }
  const int place = place_along(y_m, square.y) * kSide + place_along(x_m, square.x);
  last_->covered |= std::uint64_t{1} << place;
  last_->height_sum += static_cast<std::uint64_t>(
      std::clamp((z_m / kLevel_m - key.level) * kHeightSteps, 0.0, kHeightSteps));
  if (last_->points < UINT32_MAX) ++last_->points;
}

const FloorFinder::Level* FloorFinder::level(const Key& key) const {
  const auto found = levels_.find(key);
  return found == levels_.end() ? nullptr : &found->second;
}

std::uint64_t FloorFinder::covered(const Key& key) const {
  const Level* const own = level(key);
  const Level* const next = level({key.square, key.level + 1});
  return (own ? own->covered : 0) | (next ? next->covered : 0);
}

// How many of the square's places are covered, with most of their neighbours and nothing above.
std::uint32_t FloorFinder::wide_places(const Key& key) const {
  const std::uint64_t own = covered(key);
  const std::uint64_t clear = own & ~covered({key.square, key.level + 2});
  if (clear == 0) return 0;
  std::array<std::uint32_t, kSide + 2> rows{};  // with a margin from the squares around
  for (std::int32_t dy = -1; dy <= 1; ++dy) {
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      const bool middle = dx == 0 && dy == 0;
      const std::uint64_t bits =
          middle ? own : covered({{key.square.x + dx, key.square.y + dy}, key.level});
      for (std::int32_t y = 0; y < kSide; ++y) {
        const std::int32_t row = y + 1 + dy * kSide;
        if (row < 0 || row >= kSide + 2) continue;
        const auto line = static_cast<std::uint32_t>(bits >> (y * kSide)) & 0xFFU;
        rows[static_cast<std::size_t>(row)] |=
            (dx < 0 ? line >> (kSide - 1) : line << (1 + dx * kSide)) & 0x3FFU;
      }
    }
  }
  std::uint32_t wide = 0;
  for (std::size_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      if ((clear >> (y * kSide + x) & 1U) == 0) continue;
      int here = 0;
      for (std::size_t row = y; row < y + 3; ++row) here += std::popcount(rows[row] >> x & 7U);
      if (here >= kWidePlaces) ++wide;
    }
  }
  return wide;
}

FloorFinder::Flats FloorFinder::flats() const {
  Flats out;
  for (const auto& [key, own] : levels_) {
    Flat flat{key.level, wide_places(key), 0, 0};
    std::vector<Flat>& of_square = out[key.square];  // also of a square without any
    if (flat.places == 0) continue;
    for (std::int32_t step = 0; step < 2; ++step) {
      const Level* const part = level({key.square, key.level + step});
      if (part == nullptr) continue;
      flat.points += part->points;
      flat.z_sum_m += ((key.level + step) * static_cast<double>(part->points) +
                       static_cast<double>(part->height_sum) / kHeightSteps) *
                      kLevel_m;
    }
    of_square.push_back(flat);
  }
  for (auto& [square, of_square] : out) std::ranges::sort(of_square, {}, &Flat::level);
  return out;
}

// The lowest strong level of a square and those next to it.
std::optional<FloorFinder::Flat> FloorFinder::around(const Flats& flats,
                                                     const FloorSquare& square) {
  std::map<std::int32_t, Flat> sums;
  for (std::int32_t dy = -1; dy <= 1; ++dy) {
    for (std::int32_t dx = -1; dx <= 1; ++dx) {
      const auto found = flats.find({square.x + dx, square.y + dy});
      if (found == flats.end()) continue;
      for (const Flat& flat : found->second) {
        Flat& sum = sums.try_emplace(flat.level, Flat{flat.level, 0, 0, 0}).first->second;
        sum.places += flat.places;
        sum.points += flat.points;
        sum.z_sum_m += flat.z_sum_m;
      }
    }
  }
  std::uint32_t most = 0;
  for (const auto& [level, sum] : sums) most = std::max(most, sum.places);
  for (auto at = sums.begin(); at != sums.end(); ++at) {
    if (at->second.places < kLeastPlaces || at->second.places < most / 4) continue;
    // The level below a floor has it too, in part: the floor is the uppermost that has most.
    for (auto next = std::next(at); next != sums.end() && next->first == at->first + 1 &&
                                    next->second.places >= at->second.places;
         ++next) {
      at = next;
    }
    return at->second;
  }
  return std::nullopt;
}

FloorHeights FloorFinder::find() {
  if (levels_.size() > kMostLevels) {
    throw NoFloorPlan("its points lie in more than " + std::to_string(kMostLevels) +
                      " places of 2 x 2 x 0.1 m, too many to look for a floor; cut the map, "
                      "or leave out what is not the building");
  }
  const Flats found = flats();
  levels_.clear();
  last_ = nullptr;
  FloorHeights heights;
  for (const auto& [square, own] : found) {
    const std::optional<Flat> hood = around(found, square);
    if (!hood) continue;
    const Flat* best = &*hood;
    std::uint32_t most = kLeastOfSquare;
    for (const Flat& flat : own) {
      if (std::abs(flat.level - hood->level) > kSlopeLevels || flat.places < most) continue;
      best = &flat;
      most = flat.places;
    }
    heights.z_m[square] = best->z_sum_m / best->points;
  }
  if (!heights.z_m.empty()) return heights;
  throw NoFloorPlan(
      "no floor in its points or voxels (level ground of at least 2 m2 that is wider than a wall), "
      "so no slice at a robot's height; if z is not up, turn the map before");
}

}  // namespace zonepack::packer
