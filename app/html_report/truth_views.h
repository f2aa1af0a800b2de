// A map drawn from where the simulated cameras truly were, beside what they would have seen.
#pragma once

#include <vector>

#include "app/html_report/view_section.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/evaluation/evaluate_truth.h"
#include "fovea/map/colored_points.h"

namespace fovea::app {

/// Distance of map points to the nearest true surface, cm.
inline const ErrorScale kSurfaceScale{"distance to the true surface", " cm", {0.5, 1, 2, 5, 10}};
/// Against perfect images; the map's exposure taken up by a gain.
inline const ErrorScale kPerfectScale{"colour error", "", kTeScale.bounds};

/// The points as they are drawn.
struct TruthPoints {
  ColoredPoints coloured;      ///< the truth's local frame
  std::vector<float> spacing;  ///< see sample_spacing
};
TruthPoints drawable(const TruthEvaluation& evaluation);

/// Map points in one perfect image, at most one in each cell of kCell x kCell pixels: the one next
/// to the cell's middle of those that the drawn map shows there.
struct PointsInView {
  static constexpr int kCell = 6;
  std::vector<std::uint32_t> index;     ///< in the points
  std::vector<Eigen::Vector2d> pixels;  ///< an entry a point, as all that follow
  std::vector<double> depth;            ///< m
};
PointsInView points_in_view(const ColoredPoints& points, const SplatView& drawn,
                            const Camera& camera, const RigidMotion& T_cam_points);

/// Difference of each point's colour to the perfect image, after one gain a channel that the points
/// on true surfaces (within 5 cm) need.
std::vector<float> perfect_color_errors(const ColoredPoints& points, const PointsInView& view,
                                        const std::vector<float>& distance, const Image& perfect);

/// Frames in all cameras that the drive is open with, at most kMaxViews panels: the frame whose
/// pose is worst first, then as many of the others, evenly spread, as there is room for.
std::vector<ViewPanel> truth_views(const TruthEvaluation& evaluation, const TruthPoints& points,
                                   const DriveTruth& truth, const std::vector<Camera>& cameras);

}  // namespace fovea::app
