// Whether a map's colours hang together: where the photograph is smooth the map should be smooth,
// and a point should look alike from wherever it is seen.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fovea/rendering/splat.h"

namespace fovea {

/// Roughness that the map has and the photograph has not.
struct RoughnessSums {
  /// Patches are squares of this many pixels, all drawn, where the photograph's luma deviates by at
  /// most kSmooth (standard deviation, 0-255).
  static constexpr int kPatch = 8;
  static constexpr double kSmooth = 3;
  std::size_t patches = 0;
  double excess = 0;  ///< sum over patches of the map's variance of luma less the photograph's

  RoughnessSums& operator+=(const RoughnessSums& other);
  /// Square root of the mean excess, 0 if that is negative; NaN without patches.
  double roughness() const;
};
RoughnessSums compare_roughness(const SplatView& drawn, const Image& photograph);

/// Gathers over views how a map point's colour differs from the photographs that show it.
class CrossViewTest {
 public:
  static constexpr std::size_t kStride = 8;  ///< every 8th map point is asked

  /// @param map  must outlive the test
  explicit CrossViewTest(const ColoredPoints& map);

  /// Takes the colors (nearest pixel) of the points that the view shows: those not over 5 cm and
  /// 2% behind the drawn surface. Saturated and dark pixels do not count. Thread-safe; sums are of
  /// integers, so that the order of views does not matter. Colors of a gray photograph are lumas.
  /// @param drawn  the map in this view
  /// @param gains  factors of the channels: photograph = map * gain
  void add_view(const SplatView& drawn, const Camera& camera, const RigidMotion& T_cam_local,
                const Image& photograph, const Eigen::Vector3f& gains);

  struct Result {
    std::size_t points = 0;  ///< that two views or more show
    /// RMS of the natural logarithm of view / map, per channel: mean of each point's views.
    double map = 0;
    /// The same about the mean of the point's views: no map of one colour a point can be better.
    double floor = 0;
  };
  Result result() const;  ///< NaN without points

 private:
  struct Sums {
    std::int64_t squares = 0, errors = 0;
    std::int32_t views = 0;
    std::array<std::int32_t, 3> codes{};  // in the exposure of the map
  };
  const ColoredPoints& map_;
  std::vector<Sums> sums_;  // of points 0, kStride, ...
};

}  // namespace fovea
