// Options of the default method.
#pragma once

#include "fovea/foveal_region.h"
#include "fovea/mapping/registration/local_map.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/mapping/surface.h"
#include "fovea/pipeline/dynamic_points.h"
#include "fovea/pipeline/fusion.h"
#include "fovea/pipeline/registration_check.h"

namespace fovea {

/// Registration of scans to the local map (docs/method.md 2).
struct RefinementOptions {
  double voxel = 0.25;  ///< m, at most one registered point a voxel; 0: no thinning
  CorrectionLimits limits;
  double range_noise = 0.02;  ///< m, of the LiDAR
  /// The robust kernel suppresses moving objects. More points give no accuracy: their common errors
  /// dominate.
  RegistrationOptions registration{
      .method = RegistrationMethod::kPointToPlane, .max_points = 12000, .robust_width = 0.1};
  LocalMapOptions local_map;
};

struct MapperOptions {
  bool compensate_motion = true;  ///< sweep motion, where the drive's scans are raw
  RefinementOptions refinement;
  FovealOptions foveal{.periphery_range = 60};
  /// 0: derived from the LiDAR's ring spacing (pipeline/drive_sensors.h).
  SurfaceOptions surface{.max_edge = 0, .planar_edge = 0};
  double footprint = 0.015;  ///< m, edge of the surface patch whose mean color a point gets
  DynamicPointOptions dynamic;
  FusionOptions fusion;
  double tile_size = 4.0;  ///< m
};

}  // namespace fovea
