#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

constexpr double kVoxel = 0.25;  // m

/// A thinned scan with normals.
struct ScanSurfaces {
  RegistrationCloud cloud;
  PointIndex index;

  explicit ScanSurfaces(const PointCloud& scan)
      : cloud(prepare_cloud(voxel_thinned(scan.position, float(kVoxel)), {}, kVoxel)),
        index(cloud.points, kVoxel) {}
};

PlaceFit fit(const ScanSurfaces& target, const ScanSurfaces& source,
             const RigidMotion& T_target_source) {
  constexpr PlaceFitOptions kOptions{.pair_distance = 1, .on_plane = 0.1f, .alike = 0.5f};
  return place_fit(target.cloud, target.index, source.cloud, T_target_source, kOptions);
}

}  // namespace

bool ScanFit::shows_one_place() const {
  constexpr double kLeastOverlap = 0.5, kLeastOnPlane = 0.6;
  return vertical >= kLeastPoints && overlap >= kLeastOverlap && on_plane >= kLeastOnPlane;
}

ScanFit scan_fit(const PointCloud& target, const PointCloud& source,
                 const RigidMotion& T_target_source) {
  const ScanSurfaces a(target), b(source);
  const PlaceFit forward = fit(a, b, T_target_source);
  const PlaceFit back = fit(b, a, T_target_source.inverse());
  const auto score = [](const PlaceFit& one) { return one.overlap * one.on_plane; };
  const PlaceFit& better = score(forward) > score(back) ? forward : back;
  return {better.vertical, better.overlap, better.on_plane};
}

}  // namespace fovea
