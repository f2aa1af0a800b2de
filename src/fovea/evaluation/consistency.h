// Whether a map's colours hang together: where the photograph is smooth the map should be smooth,
// and a point should look alike from wherever it is seen.
#pragma once

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

  /// Takes the colours (nearest pixel) of the points that the view shows: those not over 5 cm and
  /// 2% behind what is drawn there. Thread-safe; sums are of integers, so that the order of views
  /// does not matter. Colours of a grey photograph are intensities.
  /// @param drawn  the map in this view
  void add_view(const SplatView& drawn, const Camera& camera, const RigidMotion& T_cam_local,
                const Image& photograph);

  struct Result {
    std::size_t points = 0;  ///< that two views or more show
    double map = 0;          ///< root mean square of |C_n - C_view|: mean of each point's views
    /// The same about the mean of the point's views: no map of one colour a point can be better.
    double floor = 0;
  };
  Result result() const;  ///< NaN without points

 private:
  struct Sums {
    std::uint64_t views = 0, r = 0, g = 0, b = 0, squares = 0, errors = 0;
  };
  const ColoredPoints& map_;
  std::vector<Sums> sums_;  // of points 0, kStride, ...
};

}  // namespace fovea
