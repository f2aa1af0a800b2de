// Ray filtering (paper: Ray-filtering and Texture Mapping; docs/method.md 5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/camera.h"

namespace fovea {

struct RayFilterOptions {
  int window = 5;             ///< M: edge of the pixel window, odd
  double outlier_rate = 2.0;  ///< c: smaller rejects more
};

/// Verdict on a scan point.
enum class RayVerdict : std::uint8_t {
  kVisible,    ///< new surface: is colored and added
  kOccluding,  ///< hides a map point
  kOccluded,   ///< its length is an outlier among the neighboring rays
  kShared,     ///< a nearer point of the scan owns the pixel (our reading of the paper)
};

/// A ray from a point to the camera center.
struct Ray {
  Eigen::Vector2f pixel;  ///< projection, inside the image
  float length;           ///< m
};

/// The ray filter of one camera. Keeps its pixel grids between frames.
///
///   RayFilter filter;
///   const std::vector<RayVerdict> verdicts = filter.filter(scan_rays, map_rays, camera, {});
///
/// Step 1 (paper: "we assign p to a ray having shortest ray-length d"): the shortest ray owns a
/// pixel. A scan point is occluding if it owns a pixel to which a map point projects. Step 2 (paper
/// Eq. 1-2): the M x M window around a scan point gives the mean length of the owners. The point is
/// visible if its length is within c standard deviations of it. Ties go to the map, then to the
/// lower index.
///
/// A value differs from the mean of N values by at most (N - 1) / sqrt(N) deviations: with c = 2,
/// windows of five or fewer rays reject nothing.
class FOVEA_API RayFilter {
 public:
  /// Verdict on each scan ray.
  std::vector<RayVerdict> filter(std::span<const Ray> scan, std::span<const Ray> map,
                                 const Camera& camera, const RayFilterOptions& options);

 private:
  struct Owner {
    float length;
    std::int32_t scan_index;  // kMapOwner: a map point
    bool map_point;           // whether any map point projects here
  };
  void assign_owners(std::span<const Ray> scan, std::span<const Ray> map, const Camera& camera);

  std::vector<Owner> owners_;  // height x width
};

}  // namespace fovea
