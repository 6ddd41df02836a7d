// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/folder_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "platform/process/clock.hpp"
#include "runtime/localize/camera/image_file.hpp"

namespace zonepack::localize {
namespace {

constexpr std::int64_t kMostSleep_ns = 100'000'000;  // then the run's clock is looked at again

std::string seconds_text(std::int64_t ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", static_cast<double>(ns) / 1e9);
  return text;
}

}  // namespace

std::string FolderSource::not_of_this_drive(std::int64_t run_ns) const {
  return name_ + ": its images are from " + seconds_text(images_.front().stamp_ns) + " to " +
         seconds_text(images_.back().stamp_ns) + " s, and zoned's clock is at " +
         seconds_text(run_ns) + " s; start zoned run --can log:FILE with the log of the same drive";
}

ImageSource::News FolderSource::next(std::int64_t until_ns, GreyImage& into) {
  for (;;) {
    if (next_ == images_.size()) return {State::kDone};
    const std::int64_t run_ns = run_ns_();
    if (!begun_) {
      if (run_ns < images_.front().stamp_ns - kMostAhead_ns || run_ns > images_.back().stamp_ns) {
        return {State::kBroken, not_of_this_drive(run_ns)};
      }
      while (images_[next_].stamp_ns < run_ns) ++next_;
      begun_ = true;
    }
    const std::int64_t due_in_ns = images_[next_].stamp_ns - run_ns;
    if (due_in_ns <= 0) break;
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns >= until_ns) return {};
    const double real_ns = std::ceil(static_cast<double>(due_in_ns) / speed_);
    const auto sleep_ns =
        static_cast<std::int64_t>(std::min(real_ns, static_cast<double>(kMostSleep_ns)));
    sleep_until_ns(std::min(now_ns + sleep_ns, until_ns));
  }
  const std::int64_t run_ns = run_ns_();
  News news{State::kImage};
  while (next_ + 1 < images_.size() && images_[next_ + 1].stamp_ns <= run_ns) {
    ++next_;
    ++news.skipped;
  }
  const ListedImage& listed = images_[next_++];
  Outcome<GreyImage> image = read_image(listed.file);
  if (!image) return {State::kRefused, image.error().message, news.skipped};
  into = std::move(image).value();
  into.stamp_ns = listed.stamp_ns;
  return news;
}

}  // namespace zonepack::localize
