// Where a map's points lie against the true surfaces, and how much of what was seen it has.
#pragma once

#include <array>
#include <vector>

#include "fovea/camera.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/truth_poses.h"
#include "fovea/point_cloud.h"
#include "fovea/world/surface_index.h"
#include "fovea/world/world_file.h"

namespace fovea {

/// What the true world has where each point of a cloud is nearest to it, an entry a point.
struct SurfaceMatches {
  std::vector<float> distance;      ///< m
  std::vector<Rgb> albedo;          ///< there, seen as finely as a pixel (1 cm)
  std::vector<std::uint8_t> matte;  ///< 1 if the material mirrors nothing
};
/// @param points_true  the truth's local frame
SurfaceMatches match_surfaces(const PointCloud& points_true, const World& world,
                              const SurfaceIndex& surfaces);

/// Static true hits of a scan that a map could have: 3-15 m from the LiDAR and in view of one of
/// the cameras, as in the evaluated set; without cameras in any direction.
std::vector<TrueReturn> visible_static(const std::vector<TrueReturn>& returns,
                                       const std::vector<Camera>& cameras);

/// Those of all frames, one a 5-cm voxel: the static surface that was seen.
/// @param origin_true  of the truth's local frame, that the positions are relative to
std::vector<Eigen::Vector3f> seen_surface(const DriveTruth& truth,
                                          const std::vector<PosePair>& frames,
                                          const std::vector<Camera>& cameras,
                                          const Eigen::Vector3d& origin_true);

/// Precision: share of map points this near to a true surface. Completeness: share of the seen
/// surface with a map point this near. F-score: their harmonic mean.
struct SurfaceShares {
  static constexpr std::array<int, 4> kCentimetres = {2, 5, 10, 20};
  std::array<double, 4> precision{}, completeness{}, f_score{};
  std::size_t seen = 0;  ///< voxels of seen surface
};
/// @param distance  of each map point to the nearest true surface (m)
/// @param map       the same points; not empty
/// @param seen      in the same frame and origin
SurfaceShares surface_shares(const std::vector<float>& distance,
                             const std::vector<Eigen::Vector3f>& map,
                             const std::vector<Eigen::Vector3f>& seen);

}  // namespace fovea
