// The map as a camera sees it: what new points would hide, and new colours for what is in view
// again (docs/method.md 5, 6).
#pragma once

#include <array>
#include <span>

#include "fovea/map/tile_map.h"
#include "fovea/mapping/depth_buffer.h"
#include "fovea/mapping/exposure.h"
#include "fovea/mapping/foveal_region.h"
#include "fovea/pipeline/patch_colors.h"
#include "fovea/pipeline/point_in_view.h"

namespace fovea {

/// The gain under which an image whose exposure is off colours new points: nine tenths of the way
/// to the map's exposure, so that light that changes for good is followed within seconds.
Eigen::Array3f matching_gain(const Eigen::Array3f& gain_to_map);

/// Gives new points, all in view, the view's colours, as their first ones.
/// @param points_cam  camera frame; columns frame, camera and those of the colour are set, and
///                    `reason` is marked where a gain has matched the view's exposure
void colour_new_points(PointCloud& points_cam, const ColorView& view);

/// The points of a map in one camera's view, at one moment. One object serves all views in turn:
/// its memory stays.
class SeenMap {
 public:
  /// Looks at a map, and forgets what was seen before.
  /// @param map      no point may come or go as long as this view of it is used
  /// @param region   what may be coloured; it knows the camera
  /// @param spacing  of the map's points, m
  void look(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local,
            double spacing);

  /// Marks (1) points that stand before the map, where it has been seen already: something has come
  /// between. Along a ray what is near comes into the foveal region first, so that what stands
  /// still is in the map before its background is.
  std::vector<std::uint8_t> marks_before(const PointCloud& points_cam) const;

  /// From now on these points, new ones that are not in the map, hide what is behind them, too.
  void put_in_front(const PointCloud& points_cam);

  /// How a view compares with the colours that the map has so far, where these are of two views and
  /// more.
  struct Comparison {
    /// What brings the view's colours to those of the map: the median of each channel; 1 where too
    /// few tell.
    Eigen::Array3f gain = Eigen::Array3f::Ones();
    std::size_t points = 0;  ///< compared
    double error = 0;        ///< mean difference of their channels, grey values, no gain applied
  };
  Comparison compare(const ColorView& view) const;

  /// Fuses the view's colours into the points in the region that nothing hides. Once for each
  /// look().
  /// @param map  the one looked at
  /// @return how many points were in view
  std::size_t recolour(TileMap& map, const ColorView& view) const;

 private:
  /// Points of a tile; of one length, so that threads share the work evenly.
  struct Piece {
    TileId tile;
    const TilePoints* points;
    RigidMotion T_cam_tile;
    std::uint32_t begin, end;  // in the tile
    std::size_t share;
    std::size_t first, seen;  // of those in the region, among the share's; they know their places
  };
  /// What threads fill at the same time.
  struct Share {
    std::vector<PointInView> points;  // in the region
    DepthBuffer front;                // of all in view
  };
  static constexpr std::size_t kShares = 4;

  void gather(const TileMap& map, const FovealRegion& region, const RigidMotion& T_cam_local);
  void look_at(const FovealRegion& region, Piece& piece);
  /// Calls f(begin, end, block) for points that follow each other, as the camera sees them.
  template <class F>
  void for_each_block(const PointCloud& points_cam, std::size_t begin, std::size_t end,
                      F&& f) const;
  /// Some points of a piece, as compare() wants them.
  struct Differences {
    std::vector<Eigen::Array3f> gains;
    std::size_t points = 0;
    double sum = 0;  // of the differences
  };
  /// What makes the two words of chance that a point takes to its fusion those of this view.
  using NoiseKinds = std::array<std::uint32_t, 2>;
  Differences differences_at(const Piece& piece, const PatchColors& patches) const;
  /// The colours of each piece's tile, empty where nothing of the tile was seen.
  std::vector<std::span<FusedColor>> colors_of_pieces(TileMap& map) const;
  /// @param piece_begin  of the points' piece
  /// @param first_seen   gets the points that had no colour
  /// @return how many of the points were in view
  std::size_t recolour_block(std::span<const PointInView> points, std::uint32_t piece_begin,
                             std::span<FusedColor> colors, const PatchColors& patches,
                             const NoiseKinds& noise, std::vector<std::uint32_t>& first_seen) const;
  /// Weights of views of the first places.
  void weigh(const ViewPlaces& places, std::size_t count,
             std::span<std::uint16_t, ColorBlock::kSize> weight) const;
  std::span<const PointInView> seen(const Piece& piece) const {
    return {shares_[piece.share].points.data() + piece.first, piece.seen};
  }

  Camera camera_;
  ViewSteps steps_;
  float disc_radius_ = 0;  // that a point stands for, pixels at a depth of 1 m
  std::vector<Piece> pieces_;
  std::array<Share, kShares> shares_;
  DepthBuffer front_;
};

}  // namespace fovea
