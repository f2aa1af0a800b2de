// How the values of an image follow from the colors of the map (docs/method.md 6).
#pragma once

#include <array>
#include <cmath>

#include "fovea/color.h"

namespace fovea {

/// How the values of a camera depend on the light. By default a gain changes all of them alike.
struct CameraResponse {
  /// Gray values. An exposure multiplies value + offset: 0 for a power law, 14 for sRGB.
  double offset = 0;
  /// Vignetting: coefficients of s, s^2 and s^3, where s is the squared distance from the principal
  /// point and 1 in the farthest corner.
  std::array<double, 3> vignetting{};

  /// Base-2 logarithm of the share that remains at s.
  float vignetting_at(float s) const {
    return s * (float(vignetting[0]) + s * (float(vignetting[1]) + s * float(vignetting[2])));
  }
  bool operator==(const CameraResponse&) const = default;
};

/// Of one image: image + offset = (map + offset) * 2^(gain + vignetting).
struct ViewLight {
  LogGain gain = LogGain::Zero();
  CameraResponse response;
};

/// A color of the map as an image shows it, not clamped.
/// @param map  values of the reference exposure
/// @param s    as in CameraResponse
inline Eigen::Array3f image_color(const Eigen::Array3f& map, const ViewLight& light, float s) {
  const auto offset = static_cast<float>(light.response.offset);
  const LogGain gain = light.gain + light.response.vignetting_at(s);
  return (map + offset) * gain.unaryExpr([](float log2) { return std::exp2(log2); }) - offset;
}

/// Logarithm of value + offset, in codes.
inline float exposure_code(float value, double offset) {
  return float(kColorCodeOfOne) +
         float(kColorCodesPerStop) * std::log2(value + static_cast<float>(offset));
}
/// The same of a color by its codes.
inline Eigen::Array3f exposure_codes(const Eigen::Array3f& codes, double offset) {
  if (offset == 0) return codes;
  return codes.unaryExpr([offset = static_cast<float>(offset)](float code) {
    const float value = std::exp2((code - kColorCodeOfOne) / kColorCodesPerStop);
    return kColorCodeOfOne + kColorCodesPerStop * std::log2(value + offset);
  });
}

}  // namespace fovea
