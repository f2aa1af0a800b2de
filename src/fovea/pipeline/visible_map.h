// The part of the map that a camera sees: occlusion of new points, and colors of known points
// (docs/method.md 5, 6).
#pragma once

#include <array>
#include <map>
#include <span>

#include "fovea/foveal_region.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/depth_buffer.h"
#include "fovea/mapping/view_colors.h"
#include "fovea/pipeline/point_in_view.h"

namespace fovea {

/// Color codes of an image minus those of the map.
struct MapDifferences {
  CodeDifferences recent;  ///< to the latest submaps
  CodeDifferences colors;  ///< the codes of these points in the map, not differences
  CodeDifferences ground;  ///< the same of those among them that are low
  std::map<std::size_t, CodeDifferences> earlier;  ///< to earlier submaps, by number
};

/// The points of a map in one view of one camera. Reuse one object for all views: it keeps its
/// memory.
class VisibleMap {
 public:
  /// Projects a map and discards the former view.
  /// @param map      points must neither be added nor removed while this view is in use
  /// @param region   points that may be colored; holds the camera
  /// @param spacing  of the map's points, m
  void render(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local,
              double spacing);

  /// Marks (1) points that lie in front of a surface of the map: a new object hides the surface.
  /// Near surfaces enter the white zone first, so a static surface is in the map before its
  /// background. Surfaces beyond that zone are no such evidence.
  std::vector<std::uint8_t> find_occluding(const PointCloud& points_cam) const;

  /// Adds points to the depth buffer, so that recolor() skips the map behind them.
  void add_occluders(const PointCloud& points_cam);

  /// Finds the edges of depth, at which recolor() trusts the view less: with all points added.
  void find_edges() { depth_.find_edges(); }
  /// Has recolor() trust the view less around points that move, and where their shadows fall.
  void doubt_around(std::vector<Eigen::Vector3f> moving_cam);
  const DepthBuffer& depth() const { return depth_; }

  /// Compares a view with the map, at some of the visible points of the region. Points that are
  /// saturated or dark in the view, or saturated in the map, are left out.
  /// @param below  points so far below the LiDAR are ground, m
  MapDifferences differences(const ViewColors& view, double below) const;

  /// Fuses a view's colors into the visible points of the region. At most once after render().
  /// @param map    the rendered one
  /// @param frame  of the view
  /// @return number of visible points
  std::size_t recolor(TileMap& map, const ViewColors& view, int frame) const;

 private:
  /// A range of a tile's points; chunks of equal size balance the threads' work.
  struct Chunk {
    TileId tile;
    const TilePoints* points;
    RigidMotion T_cam_tile;
    Eigen::Array3f gain_codes;  // from the tile's colors to the exposure of the map
    std::uint32_t begin, end;   // in the tile
    std::size_t shard;
    std::size_t first, count;  // its points in the region, in the shard's `points`
  };
  /// Output of one thread.
  struct Shard {
    std::vector<PointInView> points;  // in the region
    DepthBuffer depth;                // of all points in view
  };
  static constexpr std::size_t kShards = 4;

  void collect_chunks(const TileMap& map, const FovealRegion& region,
                      const RigidMotion& T_cam_local);
  void render_chunk(const FovealRegion& region, Chunk& chunk);
  /// Calls f(begin, end, block) for consecutive blocks of projected points.
  template <class F>
  void for_each_block(const PointCloud& points_cam, std::size_t begin, std::size_t end,
                      F&& f) const;
  /// One in `step` points of a chunk, all as `recent`.
  MapDifferences differences_of(const Chunk& chunk, std::size_t step, const ViewColors& view,
                                double below) const;
  /// Height of a point over the LiDAR, m.
  float height_of(const Eigen::Vector2f& pixel, float depth) const;
  /// The colors of each chunk's tile; empty if no point of the tile is in the region.
  std::vector<std::span<FusedColor>> colors_of_chunks(TileMap& map) const;
  /// @param seed           of the random rounding
  /// @param first_colored  gets the points that had no color
  /// @return number of visible points
  std::size_t recolor_chunk(const Chunk& chunk, std::span<FusedColor> colors,
                            const ViewColors& view, std::uint32_t seed,
                            std::vector<std::uint32_t>& first_colored) const;
  std::span<const PointInView> points_of(const Chunk& chunk) const {
    return {shards_[chunk.shard].points.data() + chunk.first, chunk.count};
  }

  Camera camera_;
  ViewQuantizer quantizer_;
  float white_zone_end_ = 0;  // m
  float disc_radius_ = 0;     // of a point's disc, pixels at a depth of 1 m
  std::vector<Chunk> chunks_;
  std::size_t first_recent_submap_ = 0;
  std::array<Shard, kShards> shards_;
  DepthBuffer depth_;
};

}  // namespace fovea
