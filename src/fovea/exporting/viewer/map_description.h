// The files about a map that the viewer's page reads (docs/viewer-protocol.md).
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/camera.h"
#include "fovea/map/frame_record.h"
#include "fovea/map/map_meta.h"

namespace fovea {

/// The frame's figure that is its score.
inline constexpr const char* kScoreFigure = "texture_error";

struct MapDescription {
  std::string name;
  std::size_t points = 0, colored_points = 0;
  bool live = false;
  bool mesh = false;    ///< whether its tiles have triangles instead of points
  std::string tileset;  ///< its address; empty: none yet
  bool status = false;  ///< whether status.json tells how far it has been read
  bool images = false;
  std::optional<GeodeticPoint> origin;
  double tile_size = 4;        ///< m
  double sensor_period = 0.1;  ///< s
  struct Foveal {
    double near = 0, far = 0;  ///< m from the LiDAR
  };
  std::optional<Foveal> foveal;
  std::vector<Camera> cameras;

  struct Drive {
    std::string name;
    double length = 0;  ///< m
    std::size_t frames = 0;
  };
  struct OfCity {
    int revision = 0;
    std::string session;
    std::size_t tiles = 0;
    std::array<double, 2> extent{};  ///< of the tiles to the east and to the north, m
    std::vector<Drive> drives;
  };
  std::optional<OfCity> city;  ///< of a city instead of a map
};

/// What a map tells of itself; InputError if its meta data are damaged.
MapDescription describe_map(const MapReader& map);

std::string to_json(const MapDescription& description);

/// frames.json: the frames by columns.
nlohmann::json frames_json(std::span<const FrameRecord> frames);

/// What is told of one frame: its score or null, its times by stage, its time (s) since the first
/// one's or null.
nlohmann::json score_json(const FrameRecord& frame);
nlohmann::json milliseconds_json(const FrameRecord& frame);
nlohmann::json time_json(const FrameRecord& frame, std::optional<TimeNs> first);

/// A 3x4 matrix row by row.
std::array<double, 12> matrix_rows(const RigidMotion& T);

}  // namespace fovea
