// The correction of a calibration that maximizes the edge score, and its covariance.
#pragma once

#include <array>
#include <vector>

#include "fovea/mapping/calibration/edge_score.h"

namespace fovea {

/// The parameters to estimate. The others are fixed.
using FreeParameters = std::array<bool, 9>;

/// Standard deviations of the Gaussians that smooth image edges, pixels.
constexpr double kCoarsestEdgeWidth = 8, kFinestEdgeWidth = 0.5;

/// A system of equations for the free parameters alone: rows and columns of fixed ones are zero,
/// their diagonal is positive.
CalibrationMatrix decoupled(const FreeParameters& free, CalibrationMatrix m);
/// With zeros for the fixed parameters.
CalibrationMatrix free_part(const FreeParameters& free, CalibrationMatrix m);
CalibrationVector free_part(const FreeParameters& free, CalibrationVector v);

bool is_positive_definite(const CalibrationMatrix& m);

/// A log likelihood besides the edges: gradient' x - x' curvature x / 2.
struct QuadraticTerm {
  CalibrationVector gradient = CalibrationVector::Zero();
  CalibrationMatrix curvature = CalibrationMatrix::Zero();
  CalibrationMatrix scatter = CalibrationMatrix::Zero();  ///< of the gradient

  QuadraticTerm& operator+=(const QuadraticTerm& other);
  QuadraticTerm scaled(double weight) const;
};

/// The maximum of the edge score plus other evidence, in calibration_unit()s, coarse to fine. It
/// starts without a correction.
/// @param coarsest  first of the standard deviations of the Gaussians, pixels
CalibrationVector maximize_edge_score(const std::vector<EdgeProfile>& profiles,
                                      const FreeParameters& free,
                                      const QuadraticTerm& evidence = {},
                                      double coarsest = kCoarsestEdgeWidth);

/// Scatter of the gradients at a correction. Edges of one frame have common errors, and so do edges
/// of one object in all frames: the scatter is the sum of both.
/// @param width  of the score, pixels
CalibrationMatrix edge_scatter(const std::vector<EdgeProfile>& profiles, const FreeParameters& free,
                               const CalibrationVector& x, double width = kFinestEdgeWidth);

/// Covariance of the maximum, H^-1 S H^-1 (H: curvature, S: scatter of the gradients).
/// If the delay is fixed, an unknown delay of a likely size adds to the covariance.
CalibrationMatrix edge_covariance(const std::vector<EdgeProfile>& profiles,
                                  const FreeParameters& free, const CalibrationVector& x,
                                  const CalibrationMatrix& curvature);

}  // namespace fovea
