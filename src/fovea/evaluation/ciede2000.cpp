#include "fovea/evaluation/ciede2000.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fovea {
namespace {

constexpr double kPi = std::numbers::pi;

double linear_of(double channel) {
  const double c = std::clamp(channel / 255, 0.0, 1.0);
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// CIE 15: cube root, with the tangent below (6/29)^3.
double lab_curve(double ratio) {
  constexpr double kEdge = 6.0 / 29;
  return ratio > kEdge * kEdge * kEdge ? std::cbrt(ratio) : ratio / (3 * kEdge * kEdge) + 4.0 / 29;
}

double degrees(double value) { return value * kPi / 180; }

/// sqrt(c^7 / (c^7 + 25^7)).
double chroma_weight(double chroma) {
  const double c7 = std::pow(chroma, 7);
  return std::sqrt(c7 / (c7 + 6103515625.0));
}

/// Hue angle in [0, 2 pi); 0 without chroma.
double hue_of(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double hue = std::atan2(b, a);
  return hue < 0 ? hue + 2 * kPi : hue;
}

}  // namespace

Lab lab_of(const Eigen::Vector3f& color) {
  const double r = linear_of(color.x()), g = linear_of(color.y()), b = linear_of(color.z());
  // The matrix's rows are divided by the white point that they sum to, so that white is neutral.
  const double x = (0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047;
  const double y = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
  const double z = (0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883;
  const double fx = lab_curve(x), fy = lab_curve(y), fz = lab_curve(z);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

double ciede2000(const Lab& first, const Lab& second) {
  // Eq. 2-7: chroma and hue after stretching a.
  const double mean_c = (std::hypot(first.a, first.b) + std::hypot(second.a, second.b)) / 2;
  const double stretch = 1 + 0.5 * (1 - chroma_weight(mean_c));
  const double a1 = stretch * first.a, a2 = stretch * second.a;
  const double c1 = std::hypot(a1, first.b), c2 = std::hypot(a2, second.b);
  const double h1 = hue_of(a1, first.b), h2 = hue_of(a2, second.b);
  const bool colourless = c1 * c2 == 0;

  // Eq. 8-11: differences; the hue's goes the short way round.
  double dh = colourless ? 0 : h2 - h1;
  if (dh > kPi) dh -= 2 * kPi;
  if (dh < -kPi) dh += 2 * kPi;
  const double dl = second.l - first.l, dc = c2 - c1;
  const double dhue = 2 * std::sqrt(c1 * c2) * std::sin(dh / 2);

  // Eq. 12-14: means.
  const double l = (first.l + second.l) / 2, c = (c1 + c2) / 2;
  double h = h1 + h2;
  if (!colourless) {
    if (std::abs(h1 - h2) > kPi) h += h < 2 * kPi ? 2 * kPi : -2 * kPi;
    h /= 2;
  }

  // Eq. 15-22: weights.
  const double t = 1 - 0.17 * std::cos(h - degrees(30)) + 0.24 * std::cos(2 * h) +
                   0.32 * std::cos(3 * h + degrees(6)) - 0.20 * std::cos(4 * h - degrees(63));
  const double blue = (h - degrees(275)) / degrees(25);
  const double rotation = -std::sin(degrees(60) * std::exp(-blue * blue)) * 2 * chroma_weight(c);
  const double lightness = (l - 50) * (l - 50);
  const double scaled_l = dl / (1 + 0.015 * lightness / std::sqrt(20 + lightness));
  const double scaled_c = dc / (1 + 0.045 * c);
  const double scaled_h = dhue / (1 + 0.015 * c * t);
  return std::sqrt(scaled_l * scaled_l + scaled_c * scaled_c + scaled_h * scaled_h +
                   rotation * scaled_c * scaled_h);
}

}  // namespace fovea
