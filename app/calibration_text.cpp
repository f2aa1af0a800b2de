#include "app/calibration_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fovea::app {
namespace {

constexpr int kCamForward = kCamTranslation + 2;
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

bool is_near(double ratio, double expected) {
  return ratio > 0.8 * expected && ratio < 1.25 * expected;
}

/// "2.1 % longer (+-0.2 %)".
std::string share_text(double share, double sigma, const char* more, const char* less) {
  return fmt::format("{:.1f} % {} (+-{:.1f} %)", 100 * std::abs(share), share < 0 ? less : more,
                     100 * sigma);
}

std::string focal_text(const LensCheck& lens) {
  return "a focal length " + share_text(lens.focal, lens.focal_sigma, "longer", "shorter");
}

std::string distortion_text(const LensCheck& lens) {
  return "a distortion that moves the corners of the image " +
         share_text(lens.radial, lens.radial_sigma, "outwards", "inwards");
}

}  // namespace

std::string calibration_parameter_name(int parameter) {
  constexpr std::array<const char*, kCalibrationSize> kNames{"rotation about x (right)",
                                                             "rotation about y (down)",
                                                             "rotation about z (forward)",
                                                             "points to the right",
                                                             "points down",
                                                             "points forward",
                                                             "delay of the images"};
  return kNames.at(static_cast<std::size_t>(parameter));
}

std::string missing_evidence(const CalibrationEstimate& estimate, int parameter) {
  const auto& observable = estimate.observable;
  if (estimate.disagrees || observable.at(static_cast<std::size_t>(parameter))) return "";
  const bool has_rotation = std::any_of(observable.begin(), observable.begin() + kCamTranslation,
                                        [](bool is_observable) { return is_observable; });
  // Without any rotation there are too few edges for all other values, too.
  if (parameter < kCamTranslation || !has_rotation) {
    return "record more edges of objects: poles, corners, vehicles";
  }
  if (parameter == kCamDelay) {
    return observable.at(kCamForward) ? "move faster and at different speeds, or turn"
                                      : "move or turn while recording";
  }
  if (parameter == kCamForward && estimate.delay_observable()) {
    return "drive at different speeds: at a steady one, a shift forward looks like a delay";
  }
  return "record objects nearer to the camera";
}

std::string lens_text(const LensCheck& lens) {
  if (!lens.is_checked) return "The lens is not checked: there are too few edges.";
  if (lens.has_odd_focal() && lens.has_odd_distortion()) {
    return fmt::format("Edges fit better with {} and {}: check K and the distortion.",
                       focal_text(lens), distortion_text(lens));
  }
  if (lens.has_odd_focal()) {
    return fmt::format("Edges fit better with {}: check K.", focal_text(lens));
  }
  if (lens.has_odd_distortion()) {
    return fmt::format("Edges fit better with {}: check the distortion.", distortion_text(lens));
  }
  return "Focal length and distortion agree with the edges.";
}

std::string imu_disagreement(const ImuHandEye& estimate) {
  if (estimate.agrees) return "";
  const double ratio = estimate.turn_ratio;
  if (is_near(ratio, kDegreesPerRadian)) {
    return fmt::format(
        "The turns of the IMU are {:.0f} times those of the LiDAR: its rates are in degrees per "
        "second, state them in rad/s.",
        ratio);
  }
  if (is_near(ratio, 1 / kDegreesPerRadian)) {
    return "The turns of the IMU are 1/57 of those of the LiDAR: a factor of pi/180 is applied to "
           "its rates, remove it.";
  }
  if (estimate.mirrored) {
    return "An axis of the IMU has the wrong sign: the IMU turns as in a mirror, check its axes.";
  }
  if (ratio > 0 && !is_near(ratio, 1)) {
    return fmt::format(
        "The turns of the IMU are {:.2f} times those of the LiDAR: check the unit of its rates.",
        ratio);
  }
  return "No mount and no delay up to 0.25 s make their turns equal: check the stamps and the axes "
         "of the IMU.";
}

}  // namespace fovea::app
