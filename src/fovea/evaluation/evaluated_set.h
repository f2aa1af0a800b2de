// THE EVALUATED SET (docs/method.md 7): which LiDAR points of a scan score a map, and their true
// colours. Fixed, and independent of any map's settings.
#pragma once

#include <optional>
#include <vector>

#include "fovea/drive/frame_source.h"

namespace fovea {

/// Points are evaluated between these ranges from the LiDAR, as measured (m, both excluded).
inline constexpr float kEvaluatedNear = 3.0f, kEvaluatedFar = 15.0f;
/// ... and this far in front of the scored camera (m, excluded).
inline constexpr double kEvaluatedDepth = 0.5;

/// Ranges as measured, m, both excluded.
struct RangeBand {
  float near = kEvaluatedNear, far = kEvaluatedFar;
};

/// Where a frame's scan is placed.
struct PlacedFrame {
  int index = 0;
  RigidMotion T_local_lidar = RigidMotion::Identity();
  /// Of the LiDAR during the sweep; absent: not compensated.
  std::optional<SweepMotion> motion;
};

/// The evaluated points of one scan in one scored camera.
struct EvaluatedView {
  int frame = 0;
  int camera = 0;
  bool grey = false;                           ///< the camera's image has one channel
  std::vector<Eigen::Vector3f> position;       ///< local frame, relative to the origin asked for
  std::vector<Eigen::Vector3f> color;          ///< 0-255; three equal channels if grey
  std::vector<Eigen::Vector2d> pixel = {};     ///< where the colour was taken
  std::vector<std::uint32_t> scan_index = {};  ///< of the point in the scan
};

/// The points whose mark is 1. @param marks  one a point
EvaluatedView select(const EvaluatedView& view, const std::vector<std::uint8_t>& marks);

/// The points whose pixels a mask does not cover. @param mask  nullptr: all
EvaluatedView without_masked(const EvaluatedView& view, const ImageMask* mask);

/// Pixel of a point that a camera can score: over 0.5 m in front of it and inside [0, W-1) x [0,
/// H-1).
std::optional<Eigen::Vector2d> scored_pixel(const Camera& camera, const Eigen::Vector3d& p_cam);

/// The scan with the sweep's motion taken out; as it is where the drive has done that already or
/// the frame's motion is unknown.
PointCloud compensated_scan(const PointCloud& scan_lidar, const PlacedFrame& placed,
                            const DriveInfo& drive);

/// @param measured_lidar     scan as measured, origin 0: its ranges decide
/// @param compensated_lidar  the same points in the same order, motion compensated
/// @param image              of `camera`
/// @param origin_local       that the positions are made relative to
/// @param band               other ranges than those of the evaluated set
EvaluatedView evaluated_view(const PointCloud& measured_lidar, const PointCloud& compensated_lidar,
                             const PlacedFrame& placed, const Camera& camera, const Image& image,
                             const Eigen::Vector3d& origin_local, const RangeBand& band = {});

}  // namespace fovea
