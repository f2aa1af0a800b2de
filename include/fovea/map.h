// Map files: what they have, and their points.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/image.h"
#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"
#include "fovea/sweep_motion.h"
#include "fovea/time.h"

namespace fovea {

enum class FrameStatus { kMapped, kHeldOut, kSkipped };
/// "mapped", "held-out" or "skipped".
FOVEA_API const char* to_string(FrameStatus status);

/// The image of one camera in a frame of a map.
struct MappedView {
  int camera = 0;               ///< its number
  std::optional<TimeNs> stamp;  ///< when the image was taken
  /// Base-2 logarithms of the gains of red, green and blue: image = map * 2^gain. Absent: not
  /// estimated.
  std::optional<Eigen::Vector3d> log2_gain;
};

/// A frame of a map.
struct MappedFrame {
  int index = 0;
  std::optional<TimeNs> stamp;
  FrameStatus status = FrameStatus::kMapped;
  std::string note;  ///< why it was skipped, or what a user should know of it
  /// Of a skipped frame interpolated between its neighbors.
  RigidMotion T_local_lidar = RigidMotion::Identity();
  std::map<std::string, double> figures;                     ///< by name (docs/map-format.md)
  std::map<std::string, double> milliseconds = {};           ///< wall time by stage
  std::optional<RigidMotion> T_local_lidar_navigation = {};  ///< pose by GPS/INS
  RigidMotion T_odom_lidar = RigidMotion::Identity();        ///< in a frame without jumps
  int submap = -1;                                           ///< -1: of a skipped frame
  std::optional<SweepMotion> motion = {};                    ///< of the LiDAR at the stamp
  std::vector<MappedView> views = {};                        ///< used images, by camera
};

/// Which points of a map to read.
struct PointQuery {
  /// Corners of a box in the frame `local`, m, borders included; absent: everywhere.
  struct Box {
    Eigen::Vector3d low, high;
  };
  std::optional<Box> box = {};
  std::string where = {};  ///< "views >= 2 and range < 10" (docs/exports.md); empty: all
};

/// A map file. The present state counts, also while a program still writes the map.
///
///   const Map map("street.fovea");
///   const PointCloud points = map.points({.where = "views >= 2"});
///   const std::vector<Rgb> colors = map.colors(points);
///
/// One thread at a time may use it.
class FOVEA_API Map {
 public:
  /// @throws InputError  if the file is missing or damaged, or is no map; so do all functions
  explicit Map(const std::filesystem::path& file);
  ~Map();
  Map(Map&&) noexcept;

  std::size_t size() const;                         ///< number of points
  std::vector<MappedFrame> frames() const;          ///< by index
  std::map<std::string, std::string> meta() const;  ///< by key (docs/map-format.md)
  /// The points that pass, in the frame `local`, m. Of tiles outside the box nothing is read.
  /// @throws ConfigError  for conditions that are not understood, or a box without a volume
  PointCloud points(const PointQuery& query = {}) const;
  /// The colors of points of this map as pictures show them, in the median exposure of the images;
  /// gray where no camera saw the point. to_rgb() gives them in the exposure of the map.
  std::vector<Rgb> colors(const PointCloud& points) const;
  /// Hash of everything but timings: the same for the same map.
  std::string digest() const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

}  // namespace fovea
