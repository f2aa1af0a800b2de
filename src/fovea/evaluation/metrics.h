// Errors of a map at the evaluated points (docs/method.md 7; paper: Error Metrics).
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/image.h"

namespace fovea {

/// Coverage is the share of evaluated points with a map point this near (m, included).
inline constexpr float kCoverageFine = 0.05f, kCoverageCoarse = 0.20f;
/// A colour is right within this Euclidean distance in RGB (included).
inline constexpr float kColorWithin = 20.0f;

/// TE of one point: |C - C_n|, Euclidean in RGB (0-441); for a grey camera the difference of the
/// intensities (0-255), the map's being its luma.
float color_error(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool grey);

/// What the map has at each evaluated point: its nearest point.
struct NearestSamples {
  std::vector<float> distance;         ///< m
  std::vector<Eigen::Vector3f> color;  ///< 0-255
  /// 1 if made by upsampling, 0 if measured; empty where the map does not say.
  std::vector<std::uint8_t> interpolated = {};
  std::vector<std::uint32_t> index = {};  ///< of the nearest point
};
/// @param tree          of the map's points, in the frame and origin of `positions`; not empty
/// @param color         of the same points
/// @param interpolated  of the same points, or empty
/// @param left_out      marks of the same points: 1 is none of the map; empty: all are
NearestSamples nearest_samples(const std::vector<Eigen::Vector3f>& positions, const KdTree& tree,
                               std::span<const LogColor> color,
                               std::span<const std::uint8_t> interpolated = {},
                               std::span<const std::uint8_t> left_out = {});

/// Fits the gains that take the map's exposure to a view's: per channel the g_c of least squares,
/// minimising sum (C_c - g_c * C_n,c)^2, not clamped; 1 where the map is black. One gain for a grey
/// camera.
class GainFit {
 public:
  void add(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool grey);
  Eigen::Vector3f gains() const;

 private:
  Eigen::Array3d products_ = Eigen::Array3d::Zero(), squares_ = Eigen::Array3d::Zero();
};
/// Of all points of a view.
Eigen::Vector3f fit_gains(const std::vector<Eigen::Vector3f>& truth,
                          const std::vector<Eigen::Vector3f>& map, bool grey);

/// Errors of evaluated points, one entry a point each; of a map without colors `position` alone.
struct PointErrors {
  std::vector<float> position;                  ///< ME of the point: |P - P_n|, m
  std::vector<float> color;                     ///< TE of the point
  std::vector<float> color_gain;                ///< TE after the view's fitted gains
  std::vector<float> ciede2000 = {};            ///< TE as CIEDE2000, without gains
  std::vector<std::uint8_t> interpolated = {};  ///< of the nearest point; empty: not known
  // After cross-fitted gains (cross_fit.h):
  std::vector<float> color_cross = {};   ///< TE of the point
  std::vector<float> log_cross = {};     ///< log_color_error()
  std::vector<float> square_cross = {};  ///< squared difference, mean over channels
  /// TE with the predicted gain (predicted_light.h); empty where the map states no gains.
  std::vector<float> color_predicted = {};

  void append(const PointErrors& other);
  /// Those of the points whose mark is `wanted` (0 or 1). @param marks  one a point
  PointErrors select(const std::vector<std::uint8_t>& marks, std::uint8_t wanted) const;
};
/// @param predicted_colors  of the map at the points of the view; empty where the map states no
/// gains
PointErrors point_errors(const EvaluatedView& view, const NearestSamples& map,
                         const Eigen::Vector3f& gains,
                         const std::vector<Eigen::Vector3f>& predicted_colors = {});

/// Figures of a set of points; NaN where there is none. Standard deviations are the set's own (over
/// N).
struct ErrorFigures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::size_t points = 0;
  double me_mean = kNone, me_std = kNone;                     ///< m
  double te_mean = kNone, te_std = kNone, te_median = kNone;  ///< 0-441, or 0-255 for grey
  double te_within_20 = kNone;                                ///< share
  double te_percent = kNone;  ///< te_mean in % of 255, as the paper quotes it
  double te_gain_mean = kNone, te_gain_within_20 = kNone;    ///< as te_mean and te_within_20
  double te_cross_mean = kNone, te_cross_within_20 = kNone;  ///< the same, cross-fitted
  double te_predicted_mean = kNone, te_predicted_within_20 = kNone;
  double log_cross_mean = kNone;  ///< mean log_color_error()
  double psnr_cross = kNone;      ///< of the points, dB: 10 log10(255^2 / mean squared difference)
  double te_ciede2000_mean = kNone, te_ciede2000_median = kNone;  ///< see ciede2000.h
  double mtme = kNone;                                            ///< mean of ME x TE of each point
  double coverage_5cm = kNone, coverage_20cm = kNone;             ///< shares
  /// Share of the evaluated points whose nearest map point was made by upsampling.
  double share_interpolated = kNone;
};
ErrorFigures summarize(const PointErrors& errors);

}  // namespace fovea
