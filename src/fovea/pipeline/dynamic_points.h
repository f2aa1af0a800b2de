// Keeps what moves out of the map (the paper leaves it for later; docs/method.md 8): a place
// through which scans see holds nothing, whatever another scan met there.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "fovea/base/flat_map.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/range_image.h"

namespace fovea {

struct DynamicPointOptions {
  bool remove = true;   ///< false: what moves stays, as in the paper
  double range = 25.0;  ///< m from the LiDAR: nearer map points are looked at in every scan
  int free_scans = 4;   ///< see through a place after it was last seen filled, and its points go
  double row_height = RangeImage::kLeastRowHeight;  ///< rad, by the LiDAR's rings; no key
  void validate() const;                            ///< ConfigError that names the field
};

/// Evidence of free space for the voxels of a map. All evidence is of the last kMemory frame
/// numbers, so that a run that resumes and looks at those scans again decides alike.
class DynamicPointFilter {
 public:
  static constexpr int kMemory = 32;               ///< frames
  static constexpr std::size_t kVotingScans = 12;  ///< scans that judge new points: about a second

  explicit DynamicPointFilter(const DynamicPointOptions& options) : options_(options) {}

  /// Marks (1) points of a new scan that lie where most of the latest scans saw through: something
  /// has come there since. Judged by voxels of 0.2 m.
  /// @param T_odom_local  inverse of the motion that puts the latest submap into local
  std::vector<std::uint8_t> classify(const PointCloud& points_local,
                                     const RigidMotion& T_odom_local) const;

  /// Looks at the map through a scan and removes the points of voxels that it and the scans before
  /// see through: something was there and has gone; and what came with them within 40 cm beneath.
  /// @return how many points were removed
  std::size_t observe(TileMap& map, RangeImage scan, const RigidMotion& T_odom_lidar,
                      const RigidMotion& T_odom_local, int frame);

  /// The same without removing: scans that a map has been built from (resume).
  void replay(const TileMap& map, RangeImage scan, const RigidMotion& T_odom_lidar,
              const RigidMotion& T_odom_local, int frame);

 private:
  struct Voxel {
    std::uint32_t cell = 0;  // in its tile
    /// Bit k: the scan k frames before the block's frame saw the voxel filled, or saw through it.
    std::uint32_t filled = 0, free = 0;
  };
  struct Block {  // of a tile
    int frame = 0;
    std::size_t known_points = 0;  // of the tile's, the rest is new
    std::vector<Voxel> voxels;
    FlatMap<std::uint32_t> place;  // of each cell in voxels
  };
  struct Tile {
    TileId id;
    const TilePoints* points;
    Block* block;
    std::vector<std::uint32_t> kept;  // of the points, where some go
    bool shrinks = false;
  };
  struct Scan {  // placed in odom, where the latest scans never move
    RangeImage image;
    RigidMotion T_lidar_odom;
  };
  std::vector<Tile> tiles_near(const TileMap& map, const Eigen::Vector3d& center_local);
  void look(const TileMap& map, const RigidMotion& T_odom_local, int frame, Tile& tile) const;
  void select_kept(const TileMap& map, Tile& tile) const;
  std::vector<Tile> gather(const TileMap& map, RangeImage scan, const RigidMotion& T_odom_lidar,
                           const RigidMotion& T_odom_local, int frame);

  DynamicPointOptions options_;
  std::map<TileId, Block> blocks_;  // of the tiles within reach
  std::deque<Scan> scans_;          // the latest last
};

}  // namespace fovea
