// Surfaces and free space in one scan.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// State of a position in a scan.
enum class Visibility : std::uint8_t {
  kUnknown,  ///< hidden, outside the field of view, or without returns around it
  kSurface,  ///< a return is there
  kFree,     ///< every return around its ray is behind it
};

/// The nearest returns of a scan by direction. Classifies balls of about 0.15 m, not points. A ball
/// is free only if every ray within that distance (or within 0.75 degrees) ends well behind it.
/// Such rays must exist above and below. Thin objects, roofs and the road, whose rays graze them,
/// are therefore never free.
class RangeImage {
 public:
  static constexpr float kMargin = 0.3f;  ///< m: a return this near in range is at the position

  /// Least height of a row (rad). Rows must be higher than the spacing of rings, since a row
  /// without a ring has no return.
  static constexpr double kLeastRowHeight = 0.6 * std::numbers::pi / 180;

  /// @param scan_lidar  m, LiDAR frame, motion compensated
  /// @param row_height  rad, at least kLeastRowHeight
  explicit RangeImage(std::span<const Eigen::Vector3f> scan_lidar,
                      double row_height = kLeastRowHeight);

  /// @param p_lidar  m, frame of the scan's LiDAR
  Visibility visibility(const Eigen::Vector3f& p_lidar) const;
  /// The visibility of many positions.
  /// @param visibilities  output, of the same size
  void classify(std::span<const Eigen::Vector3f> p_lidar, std::span<Visibility> visibilities) const;

 private:
  /// @param row, column  of the direction
  Visibility visibility_at(float range, float row, float column) const;
  /// Nearest range and number of cells with a return in a window around each cell.
  struct Level {
    std::vector<std::uint16_t> nearest;  // steps
    std::vector<std::uint8_t> filled;
  };
  static constexpr std::size_t kLevels = 3;
  /// Merges `count` cells of one level into another.
  static void merge(const Level& from, std::size_t from_cell, Level& to, std::size_t to_cell,
                    std::size_t count);
  Level widen(const Level& cells, int half_width) const;
  /// Rows to either side with the extent of `half_width` columns.
  int half_height(int half_width) const;

  float row_height_;   // rad
  int first_row_ = 0;  // of the lowest return
  int rows_ = 0;
  std::array<Level, kLevels> levels_;
};

}  // namespace fovea
