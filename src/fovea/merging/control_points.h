// Surveyed points that a map shows (docs/city.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fovea/geometry/geodesy.h"

namespace fovea {

/// A surveyed point where one map shows it.
struct SurveyedPoint {
  std::string name;
  bool is_check = false;   ///< only compared, without influence on the poses
  GeodeticPoint position;  ///< by the survey
  double sigma = 0.02;     ///< of each coordinate, m
  std::string map;         ///< name of the drive, or the first digits of the map's identity
  Eigen::Vector3d p_local = Eigen::Vector3d::Zero();  ///< where the map shows it, m
};

/// Reads a table with the columns name, role (control or check), latitude, longitude, height (m
/// above the ellipsoid), sigma (m), map, x, y, z (m). Lines that begin with # are comments.
/// @throws InputError  if the file is missing or a line is damaged
std::vector<SurveyedPoint> read_surveyed_points(const std::filesystem::path& path);

}  // namespace fovea
