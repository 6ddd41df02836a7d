// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// What is wrong with a zone file, in messages that suffice to correct it.
namespace zonepack::packer {

// Where a finding is, for a picture; empty where it has no place.
struct FindingPlace {
  std::vector<Ring> areas;  // the common area of two zones, or the faulty outline
  std::vector<Segment2> lines;
  std::vector<Point2> points;
  bool empty() const noexcept { return areas.empty() && lines.empty() && points.empty(); }
};

struct Finding {
  std::optional<std::size_t> feature;  // index in the file's list, from 0; nullopt: the file itself
  std::size_t line = 0;                // where the feature begins, from 1; 0: unknown
  std::string name;                    // zone or portal; empty when it has none
  std::string message;                 // complete: what was found, what was expected, what to do
  FindingPlace place = {};
};

// Findings in the order they were made. Of more than kMost only the number is kept, so that a file
// in which everything is wrong costs neither memory nor screens of text.
class FindingList {
 public:
  static constexpr std::size_t kMost = 1000;
  using value_type = Finding;
  using const_iterator = std::vector<Finding>::const_iterator;

  void push_back(Finding finding) {
    if (kept_.size() < kMost) {
      kept_.push_back(std::move(finding));
    } else {
      ++left_out_;
    }
  }
  // Gives those kept a place that have none, as far as place_of(finding) knows one.
  template <typename PlaceOf>
  void locate(PlaceOf&& place_of) {
    for (Finding& finding : kept_) {
      if (finding.place.empty()) finding.place = place_of(finding);
    }
  }
  bool empty() const noexcept { return kept_.empty(); }
  std::size_t size() const noexcept { return kept_.size() + left_out_; }  // with those left out
  std::size_t left_out() const noexcept { return left_out_; }
  const_iterator begin() const noexcept { return kept_.begin(); }  // of those kept
  const_iterator end() const noexcept { return kept_.end(); }
  const Finding& operator[](std::size_t i) const noexcept { return kept_[i]; }

 private:
  std::vector<Finding> kept_;
  std::size_t left_out_ = 0;
};

struct Findings {
  FindingList faults;    // the file is rejected
  FindingList warnings;  // the file is accepted, but a person should look at it
};

// A point in the middle of the first place that a finding has; nothing without one.
std::optional<Point2> point_of(const FindingPlace& place);

// "FILE:LINE: message", without the line when unknown.
std::string to_string(const Finding& finding, const std::string& file);

// Every fault on its own line, under a heading that counts them.
std::string describe_faults(const Findings& findings, const std::string& file);

// "1.25", at most three digits after the point.
std::string number_text(double value);
// "(1.25, -3)".
std::string point_text(Point2 point);

}  // namespace zonepack::packer
