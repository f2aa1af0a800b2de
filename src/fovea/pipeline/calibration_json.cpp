#include "fovea/pipeline/calibration_json.h"

#include <nlohmann/json.hpp>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

/// Null for a value that is not observable.
nlohmann::ordered_json values_json(const Eigen::Vector3d& values, double unit,
                                   const CalibrationEstimate& e, std::size_t first) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  bool is_any_observable = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool observable = e.observable[first + k];
    list.push_back(observable ? nlohmann::ordered_json(values[Eigen::Index(k)] / unit) : nullptr);
    is_any_observable = is_any_observable || observable;
  }
  return is_any_observable ? list : nullptr;
}

nlohmann::ordered_json to_json(const CameraCalibration& camera, bool applied) {
  const CalibrationEstimate& e = camera.estimate;
  const auto delay = [&](double value) {
    return e.delay_observable() ? nlohmann::ordered_json(1e3 * value) : nullptr;
  };
  const auto pixels = [&](double value) {
    return e.is_any_observable() ? nlohmann::ordered_json(value) : nullptr;
  };
  const auto lens = [&](double value) {
    return camera.lens.is_checked ? nlohmann::ordered_json(value) : nullptr;
  };
  return {{"camera", camera.camera},
          {"applied", applied && e.is_any_observable()},
          {"frames", e.frames},
          {"edges", e.edges},
          {"rotation_deg", values_json(e.correction.rotation, kDegree, e, kCamRotation)},
          {"rotation_sigma_deg", values_json(e.sigma.rotation, kDegree, e, kCamRotation)},
          {"translation_m", values_json(e.correction.translation, 1, e, kCamTranslation)},
          {"translation_sigma_m", values_json(e.sigma.translation, 1, e, kCamTranslation)},
          {"time_offset_ms", delay(e.correction.delay)},
          {"time_offset_sigma_ms", delay(e.sigma.delay)},
          {"pixels", pixels(e.pixels)},
          {"pixels_sigma", pixels(e.pixels_sigma)},
          {"off_by_a_pixel", e.off_by_a_pixel()},
          {"disagrees", e.disagrees},
          {"focal_error", lens(camera.lens.focal)},
          {"focal_error_sigma", lens(camera.lens.focal_sigma)},
          {"distortion_error", lens(camera.lens.radial)},
          {"distortion_error_sigma", lens(camera.lens.radial_sigma)}};
}

}  // namespace

nlohmann::ordered_json to_json(const std::vector<CameraCalibration>& cameras, bool applied) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CameraCalibration& camera : cameras) list.push_back(to_json(camera, applied));
  return list;
}

nlohmann::ordered_json to_json(const std::optional<ImuHandEye>& imu) {
  if (!imu) return nullptr;
  const auto three = [](const Eigen::Vector3d& v) {
    return nlohmann::ordered_json{v.x(), v.y(), v.z()};
  };
  const auto rotation = [&](const Eigen::Vector3d& v) {
    return imu->observable_directions > 0 ? three(v / kDegree) : nullptr;
  };
  const auto delay = [&](double value) {
    return imu->delay_observable ? nlohmann::ordered_json(1e3 * value) : nullptr;
  };
  return {{"agrees", imu->agrees},
          {"is_off", imu->is_off()},
          {"turns", imu->moving_turns},
          {"observable_directions", imu->observable_directions},
          {"rotation_deg", rotation(imu->rotation)},
          {"rotation_sigma_deg", rotation(imu->rotation_sigma())},
          {"time_offset_ms", delay(imu->delay)},
          {"time_offset_sigma_ms", delay(imu->delay_sigma)},
          {"gyroscope_bias_deg_s", three(imu->gyroscope_bias / kDegree)}};
}

}  // namespace fovea
