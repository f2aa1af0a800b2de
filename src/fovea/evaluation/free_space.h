// Free-space violations (docs/method.md 7): map points that stand where a scan saw through.
// Position errors cannot see them: a map fattened by 5 cm of noise has a better ME.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/geometry/sensor_profile.h"
#include "fovea/map/colored_points.h"

namespace fovea {

/// Gathers over scans which map points stand over 20 cm in front of EVERY return within 0.4 degrees
/// of their ray. Ground between two rings does so, too, where these lie farther apart: the next
/// ring above ends behind it, the next below is not asked. Hence those points apart which
/// stand as far in front of every return within 0.7 degrees, with returns above and below them.
class FreeSpaceTest {
 public:
  static constexpr double kCone = 0.4;      ///< degrees between a point's ray and a return's
  static constexpr double kWideCone = 0.7;  ///< degrees; over the spacing of an HDL-64E's rings
  static constexpr float kInFront = 0.2f;   ///< m

  /// @param map  must outlive the test
  explicit FreeSpaceTest(const ColoredPoints& map);

  /// Tests the map points that lie 3-15 m from the scan's LiDAR, in the view of one of the
  /// `cameras` (without cameras: in any direction) and within the cone of at least one return.
  /// Thread-safe; the result does not depend on the order of scans.
  /// @param scan_lidar  the whole scan, motion compensated: returns at any range count
  /// @param lidars      whose returns these are; empty: one
  void add_scan(const PointCloud& scan_lidar, const RigidMotion& T_local_lidar,
                const std::vector<Camera>& cameras, std::span<const MountedLidar> lidars = {});

  struct Result {
    std::size_t tested = 0;     ///< map points that any scan tested
    std::size_t violating = 0;  ///< of these, points that violate in any scan
    std::size_t enclosed =
        0;                 ///< of these, points that in any scan violate among returns all round
    double share() const;  ///< of violating points; NaN if none was tested
    double enclosed_share() const;
  };
  Result result() const;
  /// Marks (1) the map points that any scan tested.
  std::vector<std::uint8_t> tested() const;

 private:
  /// The scan of one LiDAR, in its frame.
  void add_scan_of(const PointCloud& scan_sensor, const RigidMotion& T_local_sensor,
                   const std::vector<Camera>& cameras);

  const ColoredPoints& map_;
  std::vector<std::uint8_t> state_;  // bits of each map point, see the source
};

}  // namespace fovea
