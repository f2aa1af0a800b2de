// Maps of drives: a whole drive into a file, or frame by frame in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "fovea/drive.h"
#include "fovea/map.h"

namespace fovea {

/// The method and its settings.
struct MapperSettings {
  std::string preset = "default";  ///< "default", "paper" or "realtime"
  /// Values by key, as in TOML: {"surface.spacing_m", "0.05"} (docs/settings.md).
  std::map<std::string, std::string> values = {};
};

/// Maps a drive frame by frame, all in memory; map_drive() makes files.
///
///   FrameMapper mapper(drive);
///   for (const int index : drive.frames()) {
///     if (const auto frame = drive.try_load(index)) use(mapper.map(*frame).T_local_lidar);
///   }
///   use(mapper.points());
class FOVEA_API FrameMapper {
 public:
  /// With the paper's method if the settings have its preset.
  /// @throws ConfigError  for a preset, a key or a value that there is not
  explicit FrameMapper(const Drive& drive, const MapperSettings& settings = {});
  ~FrameMapper();
  FrameMapper(FrameMapper&&) noexcept;

  /// Maps the next frame of the drive.
  /// @param held_out  the frame only gets a pose
  /// @throws std::invalid_argument  for a frame of another drive, or one that is not later
  MappedFrame map(const DriveFrame& frame, bool held_out = false);
  std::size_t size() const;   ///< number of points so far
  PointCloud points() const;  ///< so far, in the frame `local` as of the last frame, m

  struct Content;
  const Content& content() const { return *content_; }

 private:
  std::unique_ptr<Content> content_;
};

struct MapOptions {
  MapperSettings settings = {};
  std::string hold_out = {};  ///< frames that add nothing: "8:4" or "120-135"; empty: none
  bool calibrate = false;     ///< corrects the calibration first
  bool resume = false;        ///< continues a map that an earlier run did not finish
  bool force = false;         ///< replaces a map
  int threads = 0;            ///< 0: all that the machine has
  std::stop_token stop = {};  ///< ends after the frames at hand; `resume` goes on with the map
};

struct MapProgress {
  int done = 0, total = 0;  ///< frames
  std::size_t points = 0;
  MappedFrame frame;  ///< the one just done
};

/// Figures of a run.
struct MapFigures {
  std::size_t frames = 0, frames_held_out = 0, frames_skipped = 0, points = 0;
  double frames_per_second = 0;
  bool interrupted = false;           ///< by MapOptions::stop
  std::vector<std::string> warnings;  ///< a line each
  std::string json;                   ///< all figures (docs/report.md)
};

/// Maps a drive into a map file.
/// @param progress  is called after each frame, in the caller's thread
/// @throws OutputError  if the file exists, except with `force` or `resume`, or cannot be written
/// @throws InputError   if no frame is usable
/// @throws ConfigError  for settings that there are not
FOVEA_API MapFigures map_drive(const Drive& drive, const std::filesystem::path& output,
                               const MapOptions& options = {},
                               const std::function<void(const MapProgress&)>& progress = {});

}  // namespace fovea
