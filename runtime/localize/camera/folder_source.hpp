// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "runtime/localize/camera/image_list.hpp"
#include "runtime/localize/camera/image_source.hpp"

namespace zonepack::localize {

// Plays a list of images on the run's time: each is given when the run's clock reaches its stamp.
// Those from before the first call are passed over. Broken when the run's clock is more than
// kMostAhead_ns before the first image or past the last one: the images are of another drive.
class FolderSource final : public ImageSource {
 public:
  static constexpr std::int64_t kMostAhead_ns = 600'000'000'000;

  // `name` stands in messages; `speed` is that of the run's clock, for how long to sleep.
  FolderSource(std::string name, std::vector<ListedImage> images, double speed, RunTime run_ns)
      : name_(std::move(name)),
        images_(std::move(images)),
        speed_(speed),
        run_ns_(std::move(run_ns)) {}

  News next(std::int64_t until_ns, GreyImage& into) override;
  ImageClock clock() const noexcept override { return ImageClock::kRun; }

 private:
  std::string not_of_this_drive(std::int64_t run_ns) const;

  const std::string name_;
  const std::vector<ListedImage> images_;
  const double speed_;
  const RunTime run_ns_;
  std::size_t next_ = 0;
  bool begun_ = false;
};

}  // namespace zonepack::localize
