// The points of a tile as memory and file keep them (docs/map-format.md): numbers in whole steps,
// finer than any sensor knows them, in two thirds of the memory that floats would take.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "fovea/core/fused_color.h"
#include "fovea/core/run_column.h"
#include "fovea/core/steps.h"
#include "fovea/point_cloud.h"

namespace fovea {

inline constexpr float kPositionStep = 0.001f;         // m
inline constexpr float kRangeStep = 0.01f;             // m
inline constexpr float kIncidenceStep = 0.008726646f;  // rad: half a degree
/// Largest edge of a tile whose points the steps reach, m.
inline constexpr double kMaxTileSize = 65.5;

inline std::uint16_t position_steps(double p) {
  return steps<std::uint16_t>(p, double(kPositionStep));
}

/// Places in a tile, a column for each of x, y, z: steps from its lowest corner.
using TilePlaces = std::array<std::vector<std::uint16_t>, 3>;

/// Columns of equal length. All tiles of a map have intensities, or none has. Columns mean what
/// they mean in PointCloud unless a comment states otherwise; normals and times are not kept.
struct TilePoints {
  using Steps = std::array<std::uint16_t, 3>;  ///< along x, y, z
  static constexpr std::uint8_t kUnknownIncidence = 255;

  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< the tile's lowest corner, submap frame, m
  TilePlaces position;
  std::vector<FusedColor> colors;  // read and written as one
  // Points come frame by frame and triangle by triangle: what these say of one it says of the next.
  RunColumn<std::int8_t> camera;
  RunColumn<std::int32_t> frame;
  std::vector<std::uint16_t> range;     ///< steps
  std::vector<std::uint8_t> incidence;  ///< steps, or kUnknownIncidence
  RunColumn<std::uint8_t> interpolated;
  RunColumn<std::uint8_t> reason;
  RunColumn<float> intensity;
  // Empty: 0 for every point.
  RunColumn<std::uint16_t> sensor;         ///< number of the LiDAR in the map's table `sensors`
  RunColumn<std::uint8_t> sampling_level;  ///< the point stands for a cell of spacing * 2^level
  RunColumn<std::uint16_t> session;        ///< number of the drive that gave the color
  /// Around some points, in steps, both ends included; without points it holds none.
  struct Box {
    Steps low{0xffff, 0xffff, 0xffff}, high{0, 0, 0};
  };
  Box box;                 ///< around all points
  std::vector<Box> boxes;  ///< around each kBoxed that follow each other: near each other, mostly
  static constexpr std::size_t kBoxed = 256;

  std::size_t size() const { return position[0].size(); }
  bool empty() const { return position[0].empty(); }

  /// Throws std::logic_error if the columns are not of one length.
  void check() const;

  /// m, relative to `origin`.
  Eigen::Vector3f position_at(std::size_t i) const {
    return {float(position[0][i]) * kPositionStep, float(position[1][i]) * kPositionStep,
            float(position[2][i]) * kPositionStep};
  }
  float range_at(std::size_t i) const { return float(range[i]) * kRangeStep; }  ///< m
  float incidence_at(std::size_t i) const;  ///< rad; NaN where unknown

  /// A tile of a cloud with its origin, rounded to steps; what is out of their range becomes the
  /// nearest that can be kept. std::logic_error as check_tile_columns().
  static TilePoints of(const PointCloud& tile);
  /// The same as a cloud, which of() turns back into the tile, except for the columns that a cloud
  /// does not have: `sensor` and `session`.
  PointCloud cloud() const;

  /// Points of a cloud that follow each other: from `begin` up to before `end`.
  struct Range {
    std::uint32_t begin, end;
  };
  /// Appends some ranges of a cloud, rounded as by of().
  /// @param places  of all points, in place of their positions
  void append(const PointCloud& points, const TilePlaces& places, std::span<const Range> ranges);
  /// Keeps only the points at `indices` (ascending), in place.
  void keep(std::span<const std::uint32_t> indices);
  /// Has the boxes hold the points from `first` on.
  void widen_boxes(std::size_t first);
};

/// Throws std::logic_error that names a column which a tile must have and `cloud` lacks, or a
/// column of a wrong length.
void check_tile_columns(const PointCloud& cloud);

/// A part of the colors, as a column.
template <class Colors, auto kPart>
struct ColorColumn {
  Colors& colors;
  using value_type = std::remove_cvref_t<decltype(std::declval<FusedColor>().*kPart)>;
};
template <auto kPart, class Colors>
ColorColumn<Colors, kPart> part_of(Colors& colors) {
  return {colors};
}

/// Calls `f(column)` for the columns of which an empty one means 0 for every point.
template <class Tile, class F>
void for_each_default_column(Tile& tile, F&& f) {
  f(tile.sensor);
  f(tile.sampling_level);
  f(tile.session);
}

/// Calls `f(column)` for each column in the order of the file (kTileColumns), of which position is
/// the first.
template <class Tile, class F>
void for_each_stored_column(Tile& tile, F&& f) {
  f(tile.position);
  f(part_of<&FusedColor::color>(tile.colors));
  f(tile.camera);
  f(tile.frame);
  f(tile.range);
  f(tile.incidence);
  f(tile.interpolated);
  f(part_of<&FusedColor::views>(tile.colors));
  f(part_of<&FusedColor::spread>(tile.colors));
  f(part_of<&FusedColor::weight>(tile.colors));
  f(tile.reason);
  f(tile.intensity);
  f(part_of<&FusedColor::saturated>(tile.colors));
  for_each_default_column(tile, f);
}
inline constexpr std::size_t kStoredColumns = 16;
inline constexpr std::size_t kColorColumn = 1;
/// The columns from here on may be missing: first the intensity, then the default columns.
inline constexpr std::size_t kFirstOptionalColumn = 11;
inline constexpr std::size_t kSaturatedColumn = 12;  // missing: 0 for every point
inline constexpr std::size_t kFirstDefaultColumn = 13;

}  // namespace fovea
