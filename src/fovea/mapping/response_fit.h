// How the values of a camera depend on the light, from points that two of its images show
// (docs/method.md 6).
#pragma once

#include <array>
#include <vector>

#include "fovea/core/view_light.h"

namespace fovea {

/// A point in an image.
struct PointInImage {
  Eigen::Array3f value;        ///< 0 to 255
  float squared_distance = 0;  ///< from the principal point; 1: the farthest corner
};

/// A point in two images.
struct SharedPoint {
  PointInImage first, second;
};

/// The response under which the points of each pair of images differ by one gain per channel:
/// robust least squares, one pair after the other. The curve is a power law, sRGB, or BT.709.
class ResponseFit {
 public:
  ResponseFit();

  /// Adds a pair of images.
  /// @param points  neither saturated nor dark
  void add(const std::vector<SharedPoint>& points);

  /// Vignetting where the points determine it: it must be known within 1.5 % and exceed three
  /// standard deviations. A power law, unless the residuals change with the value by more than 3 %
  /// per stop of exposure.
  CameraResponse response() const;

 private:
  /// Coefficients of the vignetting.
  using Coefficients = Eigen::Vector3d;
  /// Least squares under one curve.
  struct Curve {
    double offset = 0;
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Coefficients right_side = Coefficients::Zero();
    Coefficients vignetting = Coefficients::Zero();
    double squares = 0, weights = 0;  // of the errors, stops
    /// Of the residuals against the value: how much larger the offset should be.
    double offset_information = 0, offset_right_side = 0;

    void add(const std::vector<SharedPoint>& points, int channel);
    void forget(double memory);
    double variance() const;
    double offset_error() const;
  };
  struct Solution {
    CameraResponse response;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  /// No coefficient is positive, so that the light falls toward the corners.
  static Solution solve(const Curve& curve);
  const Curve& best_curve() const;
  bool is_vignetting(const Solution& solution) const;

  std::array<Curve, 3> curves_;
  double far_distances_ = 0;  // sum over pairs: nine tenths of the points are nearer, squared
  std::size_t pairs_ = 0;
};

}  // namespace fovea
