// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_source.hpp"

#include <utility>

#include "runtime/localize/camera/folder_source.hpp"
#include "runtime/localize/camera/socket_source.hpp"
#include "runtime/localize/camera/video_source.hpp"
#include "runtime/run/figures/stamp_text.hpp"

namespace zonepack::localize {
namespace {

constexpr double kLeastSpeed = 0.001, kMostSpeed = 1'000'000;

}  // namespace

Outcome<CameraChoice> parse_camera(std::string_view text) {
  const auto refused = [&] {
    return usage_failure("'" + std::string(text) +
                         "' is not v4l2:DEV, socket:PATH, folder:DIR, or folder:DIR@SPEED with "
                         "SPEED 0.001 to 1000000");
  };
  CameraChoice choice;
  const auto takes = [&](std::string_view word) {
    if (!text.starts_with(word)) return false;
    choice.place = text.substr(word.size());
    return true;
  };
  if (takes("v4l2:")) {
    choice.kind = CameraChoice::Kind::kVideo;
  } else if (takes("socket:")) {
    choice.kind = CameraChoice::Kind::kSocket;
  } else if (takes("folder:")) {
    choice.kind = CameraChoice::Kind::kFolder;
    if (const auto at = choice.place.rfind('@'); at != std::string::npos) {
      if (!parse_number(std::string_view(choice.place).substr(at + 1), choice.speed) ||
          !(choice.speed >= kLeastSpeed && choice.speed <= kMostSpeed)) {
        return refused();
      }
      choice.place.resize(at);
    }
  } else {
    return refused();
  }
  if (choice.place.empty()) return refused();
  return choice;
}

Outcome<std::unique_ptr<ImageSource>> open_camera(const CameraChoice& choice,
                                                  const CameraModel& camera, RunTime run_ns) {
  switch (choice.kind) {
    case CameraChoice::Kind::kVideo: {
      auto device = VideoDevice::open({choice.place, camera.width, camera.height});
      if (!device) return device.error();
      return std::unique_ptr<ImageSource>(
          std::make_unique<VideoSource>(choice.place, std::move(device).value()));
    }
    case CameraChoice::Kind::kSocket:
      return SocketSource::open(choice.place, camera.width, camera.height);
    case CameraChoice::Kind::kFolder:
      break;
  }
  auto images = list_image_folder(choice.place);
  if (!images) return images.error();
  return std::unique_ptr<ImageSource>(std::make_unique<FolderSource>(
      choice.place, std::move(images).value(), choice.speed, std::move(run_ns)));
}

}  // namespace zonepack::localize
