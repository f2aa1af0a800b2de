// The chosen points of a map, a block at a time, in the coordinates wanted: what every export of
// points begins with.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fovea/geometry/georeference.h"
#include "fovea/map/color_display.h"
#include "fovea/map/map_point_filter.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Colour of points that no camera has coloured, so that no program shows them as black things.
inline constexpr Rgb kUncolored{128, 128, 128};

struct PointChoice {
  bool include_uncolored = false;  ///< also points that no camera has coloured: grey, camera -1
  PointFilter where = {};          ///< only points that pass
  Crs crs = Crs::kLocal;           ///< coordinates of the positions
  ExposureChoice exposure = {};    ///< of the colors
  bool deep_colors = false;        ///< colors of 16 bits, too: see deep_color_display()
};

struct ExportFigures {
  std::size_t points = 0;  ///< chosen
  std::size_t uncolored_left_out = 0;
  std::size_t filtered_out = 0;  ///< by `where`, of the others
};

/// A point as it is exported; see PointCloud for what the columns mean.
struct ExportPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, in the CRS chosen
  float range = 0;
  float incidence = 0;  ///< NaN if unknown
  float intensity = 0;  ///< 0 in a map without
  std::int32_t frame = 0;
  Rgb color = kUncolored;
  DeepRgb deep_color{};  ///< if asked for
  std::int8_t camera = kNoCamera;
  std::uint16_t sensor = 0;  ///< number of the LiDAR
  std::uint8_t interpolated = 0, views = 0, spread = 0, reason = 0;
};

/// Counts first and streams then, both of one committed state, however the map grows meanwhile.
class PointStream {
 public:
  /// @param map     outlives the stream
  /// @param choice  likewise
  /// InputError if the map is damaged, has no georeference and `choice.crs` needs one, or states no
  /// exposure of the chosen frame.
  PointStream(const MapReader& map, const PointChoice& choice);

  /// Lets go of the state, which a writer of the map would have to wait for. From now on
  /// append_tile() takes each tile from the latest state, and nothing from a tile that is gone;
  /// for_each_block() must not be called.
  void release_state() { held_state_.reset(); }

  const ExportFigures& figures() const { return figures_; }
  const Georeference& georeference() const { return georeference_; }
  /// Whether a drive of the map has intensities. Reads one tile of each submap at most; InputError
  /// if one is damaged. Not after release_state().
  bool has_intensity() const;
  /// Of the colors: "exposure ...".
  const std::string& exposure() const {
    return deep_display_ ? deep_display_->description() : display_.description();
  }

  /// Calls f with the chosen points in the map's order, at most 65536 of one tile at a time, whose
  /// memory is f's until it returns. InputError if the map is damaged, if a position is not finite,
  /// or if the points are not as many as counted.
  void for_each_block(const std::function<void(std::span<const ExportPoint>)>& f) const;

  /// Appends the chosen points of one tile, in the map's order. InputError as above.
  void append_tile(const TileId& id, std::vector<ExportPoint>& points) const;

  /// InputError unless as many points have come as counted.
  void require_all(std::size_t streamed) const;

 private:
  bool is_chosen(std::size_t submap, const PointCloud& tile, std::size_t index) const;
  ExportPoint point(const PointCloud& tile, std::size_t index, std::size_t submap) const;
  std::size_t count_chosen() const;
  CodeCounts count_codes() const;

  const MapReader& map_;
  const PointChoice& choice_;
  std::shared_ptr<const void> held_state_;
  MapPointFilter where_;
  std::vector<RigidMotion> T_local_submap_;
  Georeference georeference_;
  ColorDisplay display_;
  std::optional<DeepColorDisplay> deep_display_;
  ExportFigures figures_;
};

}  // namespace fovea
