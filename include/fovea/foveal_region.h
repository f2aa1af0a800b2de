// The foveal region: the part of the view that is mapped (paper: Foveal Processing; docs/method.md
// 4).
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

namespace fovea {

/// An angular slice of a camera's view, about the optical axis; azimuth is positive to the right,
/// elevation is positive upwards (radians).
struct AngularSlice {
  double azimuth_min = 0, azimuth_max = 0;
  double elevation_min = 0, elevation_max = 0;
};

/// Origin of the LiDAR of a drive with one.
inline const std::vector<Eigen::Vector3d> kOneLidar{Eigen::Vector3d::Zero()};

struct FOVEA_API FovealOptions {
  double near_range = 3.0;  ///< m from the LiDAR: end of the near blind zone (the vehicle)
  double far_range = 18.0;  ///< m from the LiDAR: end of the white zone
  /// m from the LiDAR: end of the periphery, which has coarser points; 0: there is none.
  double periphery_range = 0;
  /// Slices whose union is processed; empty: the whole view of the camera.
  std::vector<AngularSlice> slices = {};
  /// Slices of single cameras by number, in place of `slices`.
  std::map<int, std::vector<AngularSlice>> camera_slices = {};
  /// Largest angle between view ray and surface normal (the paper observes coarse texture above
  /// about 70 degrees), rad; pi / 2: no limit. Points without a normal pass.
  double max_incidence = 1.5707963267948966;

  double reach() const { return std::max(far_range, periphery_range); }
  /// Slices of a camera. Views of a LiDAR without cameras (kNoCamera) have none.
  std::vector<AngularSlice> slices_of(int camera) const;
};

/// The 3D and 2D foveal region of one camera at one moment.
///
///   const FovealRegion region({.far_range = 18}, camera, kOneLidar);
///   const PointCloud points_cam = foveal_points(scan_lidar, region);
class FOVEA_API FovealRegion {
 public:
  /// @param lidar_origins  m in the LiDAR frame, by number of the LiDAR
  FovealRegion(const FovealOptions& options, const Camera& camera,
               const std::vector<Eigen::Vector3d>& lidar_origins);

  const Camera& camera() const { return camera_; }
  /// End of the white zone, m from the LiDAR.
  double far_range() const { return options_.far_range; }
  /// End of the region, m from the first LiDAR.
  double reach() const { return reach_; }

  /// Whether a point in the camera's frame lies in the white zone or the periphery of any LiDAR,
  /// the image and a slice.
  /// @param pixel  the projection, if the result is true
  bool contains(const Eigen::Vector3f& p_cam, Eigen::Vector2f& pixel) const;
  /// The same for the zones of the LiDAR that measured the point.
  /// @param sensor  its number
  bool contains_measured(const Eigen::Vector3f& p_cam, std::size_t sensor,
                         Eigen::Vector2f& pixel) const;

  /// Whether a view may color a point of the map: in the white zone of any LiDAR, and in the
  /// periphery from no farther than it was measured.
  /// @param p_cam  camera frame
  /// @param range  from which the point was measured, m
  bool may_color(const Eigen::Vector3f& p_cam, float range) const {
    const float limit2 = std::clamp(range * range, far_range2_, reach2_);
    bool may = false;
    for (const Eigen::Vector3f& lidar_cam : lidars_in_cam_) {
      const float range2 = (p_cam - lidar_cam).squaredNorm();
      may |= (range2 > near_range2_) & (range2 < limit2);
    }
    return may;
  }
  /// Whether a point in front of the camera lies in one of its slices.
  bool in_slices(const Eigen::Vector3f& p_cam) const;
  /// False: the region is the whole view.
  bool has_slices() const { return !slices_.empty(); }

 private:
  /// Bounds of a slice as slopes of rays, which avoids an arc tangent for each point.
  struct SlopeBounds {
    float right_min, right_max;  // tan(azimuth) = x / z
    float up_min, up_max;        // tan(elevation) = -y / hypot(x, z)
  };
  bool is_in_zone(const Eigen::Vector3f& p_cam, const Eigen::Vector3f& lidar_cam) const;
  bool is_in_view(const Eigen::Vector3f& p_cam, Eigen::Vector2f& pixel) const;

  FovealOptions options_;
  Camera camera_;
  std::vector<Eigen::Vector3f> lidars_in_cam_;
  double reach_;                             // m
  float near_range2_, far_range2_, reach2_;  // m^2
  std::vector<SlopeBounds> slices_;
};

/// The points of a scan that are in the region, in the frame of its camera, origin 0.
/// @param scan_lidar  LiDAR frame
FOVEA_API PointCloud foveal_points(const PointCloud& scan_lidar, const FovealRegion& region);

/// Sets range (m from the camera) and incidence (rad between view ray and normal; NaN without a
/// normal). Removes points whose incidence exceeds `max_incidence` (rad).
/// @param points_cam  camera frame, origin 0, with normals
/// @return number of removed points
FOVEA_API std::size_t limit_incidence(PointCloud& points_cam, double max_incidence);

}  // namespace fovea
