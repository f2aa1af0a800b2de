#include "fovea/api/recorded_camera.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace fovea {
namespace {

/// A camera of Python has its name later.
std::string text_of(const DriveCamera& camera) {
  return camera.name.empty() ? "the camera" : fmt::format("camera '{}'", camera.name);
}

LensModel lens_model_of(const DriveCamera& camera) {
  constexpr std::array kModels = {LensModel::kNone, LensModel::kPlumbBob,
                                  LensModel::kRationalPolynomial, LensModel::kEquidistant};
  for (const LensModel model : kModels) {
    if (to_string(model) == camera.distortion_model) return model;
  }
  throw std::invalid_argument(
      fmt::format("{} has the distortion model '{}', not none, plumb_bob, "
                  "rational_polynomial or equidistant",
                  text_of(camera), camera.distortion_model));
}

}  // namespace

RecordedCamera recorded_camera(const DriveCamera& camera) {
  const LensModel model = lens_model_of(camera);
  const auto coefficients = lens_coefficients(model, camera.distortion);
  if (!coefficients) {
    throw std::invalid_argument(
        fmt::format("{} has no coefficients of {}", text_of(camera), camera.distortion_model));
  }
  const LensCamera optics{camera.width,
                          camera.height,
                          camera.fx,
                          camera.fy,
                          camera.cx,
                          camera.cy,
                          Lens(model, *coefficients)};
  if (camera.width < 1 || camera.height < 1 || !optics.has_pinhole()) {
    throw std::invalid_argument(fmt::format(
        "{} has a size, focal lengths or a center that no camera has", text_of(camera)));
  }
  return {camera.name, camera.number, optics, camera.T_lidar_cam};
}

}  // namespace fovea
