// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "platform/base/failure.hpp"
#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/camera/grey_image.hpp"

namespace zonepack::localize {

// The clock of an image's stamp: zoned's own (of a log that it plays, the log's), or the kernel's.
enum class ImageClock : std::uint8_t { kRun, kMonotonic, kRealtime };

// Where images come from: a folder, a socket, a camera.
//
// Threads: one.
class ImageSource {
 public:
  enum class State : std::uint8_t {
    kImage,    // `into` has a new one
    kNothing,  // none in time
    kRefused,  // there was one, and `why` says why it is of no use; others may follow
    kDone,     // there will be none any more
    kBroken,   // the same, for the reason in `why`
  };
  struct News {
    State state = State::kNothing;
    std::string why = {};
    // Images that came while the caller was busy, and that nobody saw.
    std::uint64_t skipped = 0;
  };

  virtual ~ImageSource() = default;
  ImageSource(const ImageSource&) = delete;
  ImageSource& operator=(const ImageSource&) = delete;

  // Waits for an image until monotonic_ns() reaches the time; of several that wait, the newest.
  virtual News next(std::int64_t until_ns, GreyImage& into) = 0;
  virtual ImageClock clock() const noexcept = 0;

 protected:
  ImageSource() = default;
};

// The time of the run's clock now. By it a folder is played.
using RunTime = std::function<std::int64_t()>;

// "folder:DIR[@SPEED]", "socket:PATH", "v4l2:DEV".
struct CameraChoice {
  enum class Kind : std::uint8_t { kFolder, kSocket, kVideo };
  Kind kind = Kind::kFolder;
  std::string place;
  double speed = 1;  // of a folder: of the run's clock
};
// Fails with what is expected.
Outcome<CameraChoice> parse_camera(std::string_view text);

// Opens it for images of the calibration's size. `run_ns` is used by a folder only.
Outcome<std::unique_ptr<ImageSource>> open_camera(const CameraChoice& choice,
                                                  const CameraModel& camera, RunTime run_ns);

}  // namespace zonepack::localize
