// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/calibration.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <exception>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "runtime/localize/camera/grey_image.hpp"
namespace zonepack::localize {
namespace {

constexpr std::size_t kMostBytes = 64 * 1024;  // real ones have 600 bytes
constexpr int kMostPixels = 16'384;            // of a side

// What is wrong, with the key; becomes a Failure at the edge.
struct Wrong {
  std::string what;
};

YAML::Node entry(const YAML::Node& root, const char* key) {
  const YAML::Node node = root[key];
  if (!node) throw Wrong{std::string("has no ") + key};
  return node;
}

template <typename T>
T scalar(const YAML::Node& node, const char* key) {
  T value{};
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, value)) {
    throw Wrong{std::string(key) + " is not a number"};
  }
  return value;
}

int side(const YAML::Node& root, const char* key) {
  const int value = scalar<int>(entry(root, key), key);
  if (value < 1 || value > kMostPixels) {
    throw Wrong{std::string(key) + " is " + std::to_string(value) + "; expected 1 to " +
                std::to_string(kMostPixels)};
  }
  return value;
}

// The numbers of a {rows, cols, data} map or of a plain list.
std::vector<double> numbers(const YAML::Node& node, const std::string& key) {
  const YAML::Node list = node.IsMap() ? node["data"] : node;
  if (!list || !list.IsSequence()) throw Wrong{key + ".data is not a list of numbers"};
  if (list.size() > 64) throw Wrong{key + ".data has more than 64 numbers"};
  std::vector<double> out;
  for (std::size_t i = 0; i < list.size(); ++i) {
    double value = 0;
    if (!list[i].IsScalar() || !YAML::convert<double>::decode(list[i], value) ||
        !std::isfinite(value)) {
      throw Wrong{key + ".data[" + std::to_string(i) + "] is not a finite number"};
    }
    out.push_back(value);
  }
  return out;
}

std::vector<double> numbers(const YAML::Node& root, const char* key, std::size_t count) {
  std::vector<double> out = numbers(entry(root, key), key);
  if (out.size() != count) {
    throw Wrong{std::string(key) + ".data has " + std::to_string(out.size()) +
                " numbers; expected " + std::to_string(count)};
  }
  return out;
}

void read_matrix(const YAML::Node& root, CameraModel& camera) {
  const std::vector<double> k = numbers(root, "camera_matrix", 9);
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  if (!(camera.fx > 0) || !(camera.fy > 0)) {
    throw Wrong{"camera_matrix has a focal length (first and fifth number) that is not over 0"};
  }
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    throw Wrong{"camera_matrix is not [fx, 0, cx, 0, fy, cy, 0, 0, 1]"};
  }
  if (camera.cx < 0 || camera.cx >= camera.width || camera.cy < 0 || camera.cy >= camera.height) {
    throw Wrong{"camera_matrix has its centre (third and sixth number) outside the image of " +
                size_text(camera.width, camera.height)};
  }
}

void read_distortion(const YAML::Node& root, CameraModel& camera) {
  if (const YAML::Node model = root["distortion_model"]; model) {
    const std::string name = model.IsScalar() ? model.Scalar() : "";
    if (name != "plumb_bob") {
      throw Wrong{"distortion_model is '" + name +
                  "'; zoneloc knows plumb_bob (rectify the images)"};
    }
  }
  const YAML::Node node = root["distortion_coefficients"];
  if (!node) return;
  const std::vector<double> d = numbers(node, "distortion_coefficients");
  if (!d.empty() && d.size() != 4 && d.size() != 5) {
    throw Wrong{"distortion_coefficients.data has " + std::to_string(d.size()) +
                " numbers; expected 0, 4 or 5 (k1, k2, p1, p2, k3)"};
  }
  for (std::size_t i = 0; i < d.size(); ++i) camera.distortion[i] = d[i];
}

void read_mount(const YAML::Node& root, CameraModel& camera) {
  const std::vector<double> t = numbers(root, "local_transform", 12);
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation(row, column) = t[static_cast<std::size_t>(row * 4 + column)];
    }
  }
  const double error =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > 1e-3 || rotation.determinant() < 0) {
    throw Wrong{"local_transform is not a rotation and a translation (3x4, row by row)"};
  }
  // The nearest rotation: text holds few digits.
  camera.T_base_camera.linear() = Eigen::Quaterniond(rotation).normalized().toRotationMatrix();
  camera.T_base_camera.translation() = Eigen::Vector3d(t[3], t[7], t[11]);
}

}  // namespace

Outcome<CameraModel> parse_calibration(const std::string& text, const std::string& name) {
  // OpenCV heads its files with %YAML:1.0, which YAML itself writes as %YAML 1.0.
  const std::size_t line = text.starts_with("%YAML:") ? text.find('\n') : 0;
  try {
    if (line == std::string::npos) throw Wrong{"holds nothing but its first line"};
    const YAML::Node root = YAML::Load(text.substr(line));
    if (!root.IsMap()) throw Wrong{"is no YAML map of keys and values"};
    CameraModel camera;
    camera.width = side(root, "image_width");
    camera.height = side(root, "image_height");
    read_matrix(root, camera);
    read_distortion(root, camera);
    read_mount(root, camera);
    return camera;
  } catch (const Wrong& wrong) {
    return failure(name + ": " + wrong.what +
                   "; expected a camera calibration with image_width, image_height, camera_matrix, "
                   "distortion_coefficients and local_transform (base to camera)");
  } catch (const std::exception& error) {
    return failure(name + ": is not YAML: " + error.what());
  }
}

Outcome<CameraModel> read_calibration(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return failure(file + ": cannot be read; give the camera's calibration", ErrorCode::kNotFound);
  std::string text(kMostBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) return failure(file + ": cannot be read; expected a file", ErrorCode::kIo);
  if (text.size() > kMostBytes) {
    return failure(file + ": is longer than 64 KiB, so it is no camera calibration",
                   ErrorCode::kTooLarge);
  }
  return parse_calibration(text, file);
}

}  // namespace zonepack::localize
