// Data sets as drives: one adapter for each, on top of AdapterWriter.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/writers/drive_writer.h"
#include "fovea/errors.h"

namespace fovea {

struct DataSetOptions {
  std::filesystem::path root;    ///< folder of the data set
  std::string scene;             ///< its name; empty: the only one
  std::filesystem::path output;  ///< folder to make
  bool force = false;            ///< replaces a drive there
  /// s, the part of the scene from its first scan on.
  double start = 0, duration = std::numeric_limits<double>::infinity();
  std::function<void(int, int)> progress = [](int, int) {};  ///< scans done, and all

  /// Whether a scan belongs to that part.
  bool contains(TimeNs stamp, TimeNs first) const {
    const double time = seconds(stamp - first);
    return time >= start && time < start + duration;
  }
  [[noreturn]] void throw_nothing_left() const {
    throw ConfigError("no scan lies in this part of the scene", "--start, --duration",
                      "choose an earlier start, or a longer part");
  }
};

/// Its notes name what is left out, and why.
struct DataSetFigures : Messages, DriveWriterFigures {};

/// AdapterWriter::add() for a scan from a file. What the writer refuses is the fault of the data
/// set: InputError that names the file.
void add_scan(const std::filesystem::path& file, TimeNs stamp, const LidarScan& scan,
              const std::vector<DriveImage>& images,
              const std::optional<RigidMotion>& T_world_lidar, AdapterWriter& writer);

/// The scene that the options choose: the one that `is_named` accepts, or the only one. ConfigError
/// that lists all otherwise.
std::string choose_scene(std::vector<std::string> names, const DataSetOptions& options,
                         const std::function<bool(const std::string& name)>& is_named);

/// nuScenes (nuscenes.org/nuscenes#data-format): LIDAR_TOP, the six cameras and the poses of a
/// scene. The adapter reads the tables in ROOT/v1.0-* and the files that they name.
/// InputError for tables and files that are missing or damaged, and for an unknown scene;
/// OutputError as AdapterWriter.
DataSetFigures convert_nuscenes(const DataSetOptions& options);
/// Names of the scenes, sorted.
std::vector<std::string> nuscenes_scenes(const std::filesystem::path& root);

/// KITTI-360 (cvlibs.net/datasets/kitti-360/documentation.php): the Velodyne, the two perspective
/// cameras and the poses of a sequence. Its name is that of its folder, or its number.
/// Errors as above.
DataSetFigures convert_kitti360(const DataSetOptions& options);
std::vector<std::string> kitti360_scenes(const std::filesystem::path& root);

}  // namespace fovea
