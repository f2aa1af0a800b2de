// Where one scan saw a surface, and where it saw through.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace fovea {

/// What a scan says of a place.
enum class Visibility : std::uint8_t {
  kUnknown,  ///< hidden, out of the scan's field of view, or without returns around it
  kSurface,  ///< a return lies there
  kFree,     ///< every return around its ray lies behind it
};

/// A scan's nearest returns by direction. Judges places as balls of some 0.15 m, not as points: a
/// place is free only if every ray that passes within that distance (or within 0.75 degrees) ends
/// well behind it, and such rays exist above and below. What is thin, and what rays graze (a roof,
/// the road), is therefore never taken for free.
class RangeImage {
 public:
  static constexpr float kMargin = 0.3f;  ///< m: a return this near in range is the place itself

  /// Height of a row for LiDARs whose rings lie closer (rad). Rows have to be higher than the
  /// spacing of rings: a row without a ring never holds a return.
  static constexpr double kLeastRowHeight = 0.6 * std::numbers::pi / 180;

  /// @param scan_lidar  m, LiDAR frame, motion compensated
  /// @param row_height  rad, at least kLeastRowHeight
  explicit RangeImage(std::span<const Eigen::Vector3f> scan_lidar,
                      double row_height = kLeastRowHeight);

  /// @param p_lidar  m, frame of the scan's LiDAR
  Visibility visibility(const Eigen::Vector3f& p_lidar) const;
  /// The same of many places.
  /// @param visibilities  one for each
  void classify(std::span<const Eigen::Vector3f> p_lidar, std::span<Visibility> visibilities) const;

 private:
  /// @param row, column  of the place's direction, as of returns
  Visibility visibility_at(float range, float row, float column) const;
  /// Nearest range and number of cells with a return in a window around each cell.
  struct Level {
    std::vector<std::uint16_t> nearest;  // steps
    std::vector<std::uint8_t> filled;
  };
  static constexpr std::size_t kLevels = 3;
  /// Into `count` cells of one level those of another.
  static void take_in(const Level& from, std::size_t from_cell, Level& to, std::size_t to_cell,
                      std::size_t count);
  Level widened(const Level& cells, int half_width) const;
  /// Rows to either side that reach as far as columns do.
  int half_height(int half_width) const;

  float row_height_;   // rad
  int first_row_ = 0;  // of the lowest return
  int rows_ = 0;
  std::array<Level, kLevels> levels_;
};

}  // namespace fovea
