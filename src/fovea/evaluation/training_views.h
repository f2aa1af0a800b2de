// The views that built a map, as colour rules see them: photograph, pose, and what stands in front.
#pragma once

#include <vector>

#include "fovea/evaluation/color_rules.h"
#include "fovea/evaluation/protocol.h"
#include "fovea/map/colored_points.h"

namespace fovea {

/// Views farther from a point than this give it no colour: what the evaluated set reaches, and the
/// default map (m).
inline constexpr float kViewReach = kEvaluatedFar;

struct TrainingView {
  Camera camera;
  RigidMotion T_cam_local = RigidMotion::Identity();
  Image image;
  /// m along the optical axis, width x height: the map's front surface; infinite where nothing is.
  std::vector<float> depth;
  float time = 0;  ///< s since the first training frame
};

/// The frames of the drive that may colour points: those mapped, or of a cloud all that have a
/// pose; never one that is scored or named as held out. By increasing index.
std::vector<FrameRecord> training_frames(const ScoredMap& map, const DriveInfo& drive,
                                         const std::vector<PlacedFrame>& scored,
                                         const HoldOut& hold_out);

/// The views of those of a frame's cameras that have an image; none if the drive cannot load it.
/// @param cameras    places in the drive's calibration
/// @param points     what may stand in front
/// @param spacing    of these, see sample_spacing
/// @param first      time of the first training frame
std::vector<TrainingView> load_training_views(const FrameSource& drive, const FrameRecord& record,
                                              const std::vector<std::size_t>& cameras,
                                              const ColoredPoints& points,
                                              const std::vector<float>& spacing, TimeNs first);

/// What a view says of a point; empty if it projects outside (see scored_pixel) or lies beyond
/// kViewReach. Visible is what lies at most 10 cm + 2% of its depth behind the front surface at the
/// nearest pixel.
/// @param T_cam_map  of the view, with the points' origin taken in
/// @param p          relative to that origin
/// @param normal     unit, of either sign; zero: unknown
std::optional<ColorObservation> observation_of(const TrainingView& view,
                                               const Eigen::Isometry3f& T_cam_map,
                                               const Eigen::Vector3f& p,
                                               const Eigen::Vector3f& normal);

}  // namespace fovea
