// Poses and gains of the submaps of many maps in one frame: the result of fovea adjust.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/merging/map_pair.h"

namespace fovea {

struct SubmapPlacement {
  /// In earth-centered, earth-fixed coordinates (WGS 84).
  RigidMotion T_ecef_submap = RigidMotion::Identity();
  /// Color of the city = color in the map * 2^gain; base-2 logarithms for red, green and blue.
  Eigen::Vector3d log2_gain = Eigen::Vector3d::Zero();
};

struct PlacedMap {
  MapName name;
  std::vector<SubmapPlacement> submaps;  ///< by number
  bool is_fixed = false;                 ///< taken from earlier poses
  std::size_t matches = 0;               ///< of its submaps with other maps, that are used
  /// m, median distance of its submaps from where its georeference has them; zero if fixed.
  double moved = 0;
};

/// A match that contradicts the others.
struct RejectedMatch {
  std::string identity_a, identity_b;  ///< of the maps
  std::size_t submap_a = 0, submap_b = 0;
  double distance = 0;  ///< m, from where it places the submap of B
};

/// How far a surveyed point lies from where the city shows it.
struct PointResidual {
  std::string name;
  bool is_check = false;
  Eigen::Vector3d east_north_up = Eigen::Vector3d::Zero();  ///< city minus survey, m
};

struct CityPoses {
  /// Of the city's grid (CityGrid); it stays when drives are added.
  GeodeticPoint origin;
  std::vector<PlacedMap> maps;
  std::vector<RejectedMatch> rejected;
  std::vector<PointResidual> points;
};

}  // namespace fovea
