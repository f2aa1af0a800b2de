// What scans are registered to: the surfaces of a map or of a city, and where its drives went.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fovea/city/city.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Poses and places are in the local frame of the map, or of the city.
class SurfaceSource {
 public:
  virtual ~SurfaceSource() = default;

  /// The measured points in a ball, thinned to MapSurfaces::kVoxel.
  /// @return in the axes of local, relative to the center
  /// @throws InputError  if the map is damaged there
  virtual std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local,
                                                   double radius) = 0;

  /// Frames that no earlier call of this or of new_frames() returned: all around a place, and maybe
  /// others.
  virtual std::vector<FrameRecord> new_frames_near(const Eigen::Vector3d& place_local) = 0;
  /// All frames that no earlier call returned.
  virtual std::vector<FrameRecord> new_frames() = 0;

  /// Whether the surfaces are of many drives: then some are cars that were parked there once.
  virtual bool is_of_many_drives() const = 0;
};

/// A map. The present state counts, also while a program still writes the map.
/// @param map  must outlive the source
/// @throws InputError  if the map has no points, no mapped frame, or is damaged
std::unique_ptr<SurfaceSource> map_surface_source(const MapReader& map);

/// How many tiles of a city are open at once, if no place needs more of them.
inline constexpr std::size_t kMostOpenTiles = 32;

/// A city, of which only tiles near the latest places are open.
/// @param city  must outlive the source
/// @throws InputError  if the city has no points
std::unique_ptr<SurfaceSource> city_surface_source(const City& city,
                                                   std::size_t most_open = kMostOpenTiles);

}  // namespace fovea
