// Removes moving objects from the map (docs/method.md 8; not in the paper). Space that scans see
// through is free, even if an earlier scan measured a point there.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "fovea/core/flat_map.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/range_image.h"

namespace fovea {

struct DynamicPointOptions {
  bool remove = true;   ///< false: moving objects stay in the map, as in the paper
  double range = 60.0;  ///< m from the LiDAR: scans observe map points up to this range
  int free_scans = 4;   ///< a voxel loses its points if this many scans see through it
};

/// What one LiDAR measured of a scan.
struct SensorView {
  RangeImage image;  ///< in the frame of the sensor
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
};

/// Evidence of free space in the voxels of a map. Covers the last kMemory frame numbers, so that a
/// resumed run that replays those scans makes the same decisions.
class DynamicPointFilter {
 public:
  static constexpr int kMemory = 32;               ///< frames
  static constexpr std::size_t kVotingScans = 12;  ///< about a second

  explicit DynamicPointFilter(const DynamicPointOptions& options) : options_(options) {}

  /// Marks (1) points of a new scan in space that most of the voting scans observed as free: an
  /// object has moved there since. One decision for each voxel of 0.2 m, which includes the points
  /// up to 40 cm below: rays graze the road and never see through the lowest part of an object.
  /// @param T_odom_local  inverse of T_local_odom (fusion.h)
  std::vector<std::uint8_t> classify(const PointCloud& points_local,
                                     const RigidMotion& T_odom_local) const;

  /// Adds the evidence of a scan. A voxel is free in it if one LiDAR sees through it and none sees
  /// a surface there. If this and earlier scans see through a voxel, an object has left: removes
  /// its points, and points of the same frames up to 40 cm below.
  /// @return number of removed points
  /// @param scan  of all LiDARs; that of the first one first
  std::size_t observe(TileMap& map, std::vector<SensorView> scan, const RigidMotion& T_odom_lidar,
                      const RigidMotion& T_odom_local, int frame);

  /// To be told when others remove points of a tile.
  /// @param kept  indices of the points that stay, ascending
  void follow_removal(const TileId& id, std::span<const std::uint32_t> kept);

  /// Adds the evidence of a scan that is already in the map (resume), and removes no points.
  void replay(const TileMap& map, std::vector<SensorView> scan, const RigidMotion& T_odom_lidar,
              const RigidMotion& T_odom_local, int frame);

 private:
  struct Voxel {
    std::uint32_t cell = 0;  // in its tile
    /// Bit k: the scan k frames before the evidence's frame hit the voxel, or observed it as free.
    std::uint32_t filled = 0, seen_free = 0;
  };
  struct Evidence {                // for a tile
    int frame = 0;                 // of the last scan
    std::size_t known_points = 0;  // of the tile; later points are new
    std::vector<Voxel> voxels;
    FlatMap<std::uint32_t> voxel_of_cell;
  };
  struct Tile {
    TileId id;
    const TilePoints* points;
    Evidence* evidence;
    std::vector<std::uint32_t> kept;  // points, if any are removed
    bool shrinks = false;
  };
  struct Scan {  // poses in odom never change
    std::vector<SensorView> views;
    RigidMotion T_lidar_odom;
    void classify(std::span<const Eigen::Vector3f> p_lidar,
                  std::span<Visibility> visibilities) const;
  };
  std::vector<Tile> add_scan(const TileMap& map, std::vector<SensorView> scan,
                             const RigidMotion& T_odom_lidar, const RigidMotion& T_odom_local,
                             int frame);
  std::vector<Tile> tiles_near(const TileMap& map, const Eigen::Vector3d& center_local);
  void update_evidence(const TileMap& map, const RigidMotion& T_odom_local, int frame,
                       Tile& tile) const;
  bool is_gone(const Voxel& voxel) const;
  void select_kept(const TileMap& map, Tile& tile) const;

  DynamicPointOptions options_;
  std::map<TileId, Evidence> evidence_;  // for the tiles in range
  std::deque<Scan> scans_;               // voting scans, the latest last
};

}  // namespace fovea
