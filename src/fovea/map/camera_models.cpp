#include "fovea/map/camera_models.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

constexpr std::size_t kNumbersBeforePose = 7, kNumbersOfPose = 12;
constexpr int kMostCameras = 100;
constexpr double kMaxImageSide = 1 << 20;  // pixels

std::string key_of(std::size_t drive, int camera) {
  return fmt::format("{}{}.{}", meta_key::kCameraModelPrefix, drive, camera);
}

std::string text_of(const Camera& camera) {
  std::vector<double> numbers = {
      double(camera.width), double(camera.height), camera.fx, camera.fy, camera.cx, camera.cy,
      camera.image_delay};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      numbers.push_back(camera.T_cam_lidar.matrix()(row, column));
    }
  }
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw std::invalid_argument("a camera is not finite");
  }
  return to_text(numbers);
}

bool is_image_side(double pixels) {
  return pixels >= 0 && pixels <= kMaxImageSide && pixels == std::floor(pixels);
}

/// Nothing if the text is no camera.
std::optional<Camera> camera_of(std::string_view text, int index) {
  const auto numbers = numbers_from_text(text);
  if (!numbers || numbers->size() != kNumbersBeforePose + kNumbersOfPose) return std::nullopt;
  const std::vector<double>& n = *numbers;
  if (!is_image_side(n[0]) || !is_image_side(n[1]) || !(n[2] > 0 && n[3] > 0)) return std::nullopt;
  Camera camera;
  camera.index = index;
  camera.width = int(n[0]), camera.height = int(n[1]);
  camera.fx = n[2], camera.fy = n[3], camera.cx = n[4], camera.cy = n[5];
  camera.image_delay = n[6];
  Eigen::Matrix<double, 3, 4> pose;
  for (std::size_t i = 0; i < kNumbersOfPose; ++i) {
    pose(Eigen::Index(i / 4), Eigen::Index(i % 4)) = n[kNumbersBeforePose + i];
  }
  try {
    camera.T_cam_lidar = checked_pose(pose);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  return camera;
}

}  // namespace

void store_camera_models(const std::vector<Camera>& cameras, std::size_t drive, MapMeta& meta) {
  for (const Camera& camera : cameras) meta[key_of(drive, camera.index)] = text_of(camera);
}

std::vector<Camera> camera_models(const MapMeta& meta, std::size_t drive) {
  std::vector<Camera> cameras;
  for (int index = 0; index < kMostCameras; ++index) {
    const std::string key = key_of(drive, index);
    const auto found = meta.find(key);
    if (found == meta.end()) continue;
    const std::optional<Camera> camera = camera_of(found->second, index);
    if (!camera) {
      throw InputError(fmt::format("'{}' is no camera", key), "the map's table 'meta'",
                       kRestoreMap);
    }
    cameras.push_back(*camera);
  }
  return cameras;
}

void copy_camera_models(const MapMeta& from, std::size_t drive, std::size_t as_drive, MapMeta& to) {
  for (int index = 0; index < kMostCameras; ++index) {
    const auto found = from.find(key_of(drive, index));
    if (found != from.end()) to[key_of(as_drive, index)] = found->second;
  }
}

}  // namespace fovea
