// Where the LiDAR was, in forms that other programs read: TUM, CSV and GeoJSON.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/map/frame_record.h"

namespace fovea {

// Frames that were skipped have no pose of their own, and are left out. InputError if no frame is
// left; OutputError if the file exists and `force` is false, or if it cannot be written.

/// A line for each frame: stamp (s), x y z (m), qx qy qz qw of T_local_lidar, as evo and the TUM
/// benchmark read it. InputError if a frame has no stamp.
void write_tum_trajectory(const std::vector<FrameRecord>& frames, const std::filesystem::path& path,
                          bool force);

/// CSV with a header: index, stamp (ns), status, position (m) and quaternion of T_local_lidar; of a
/// map with an origin also easting, northing, height (m) and zone in UTM on WGS 84.
void write_trajectory_table(const std::vector<FrameRecord>& frames,
                            const std::optional<GeodeticPoint>& origin,
                            const std::filesystem::path& path, bool force);

/// A line on the earth (WGS 84, ellipsoidal heights), and a point for each frame with its index and
/// stamp. InputError if the map has no origin.
void write_geojson_trajectory(const std::vector<FrameRecord>& frames,
                              const std::optional<GeodeticPoint>& origin,
                              const std::filesystem::path& path, bool force);

}  // namespace fovea
