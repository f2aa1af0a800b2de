// PCL's moving least squares behind plain numbers: no type of PCL or Eigen crosses this header.
// Debian's PCL is built for x86-64 alone, Fovea for x86-64-v3; Eigen aligns differently in the two,
// and one program must not mix them. So the peer is a shared library with options of its own.
#pragma once

#include <cstddef>

namespace fovea::bench {

enum class MlsMethod {
  kLocalPlane,      ///< SAMPLE_LOCAL_PLANE: each point's plane, sampled on a grid in a disc
  kUniformDensity,  ///< RANDOM_UNIFORM_DENSITY: random points where neighbours are few
};

struct MlsOptions {
  MlsMethod method = MlsMethod::kLocalPlane;
  double search_radius = 0.3;   ///< m, of the neighbourhood that a surface is fitted to
  int polynomial_order = 1;     ///< 1: a plane, which is PCL's cheapest
  double sample_radius = 0.15;  ///< m, kLocalPlane: of the disc
  double sample_step = 0.1;     ///< m, kLocalPlane: of the grid in it
  int points_in_radius = 10;    ///< kUniformDensity: wanted in a neighbourhood
  int threads = 1;
};

struct MlsRun {
  double seconds = 0;  ///< of MovingLeastSquares::process, its search tree included
  std::size_t points = 0;
  bool finite = true;  ///< whether all points are
};

/// @param xyz  `count` points, three numbers each (m)
__attribute__((visibility("default"))) MlsRun run_mls(const float* xyz, std::size_t count,
                                                      const MlsOptions& options);

/// How many samples kLocalPlane makes of each point: PCL's own loops over the grid.
__attribute__((visibility("default"))) int samples_in_disc(double radius, double step);

}  // namespace fovea::bench
