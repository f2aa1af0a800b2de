// Writes a drive frame by frame (docs/drives.md, "Other data sets"): the base of an adapter.
//
//     AdapterWriter writer("drive", {{"front", 0, optics, T_lidar_cam}});
//     for (const MyFrame& f : frames) {
//       writer.add({f.stamp, f.points}, {{"front", f.image_stamp, f.image_file}}, f.T_world_lidar);
//     }
//     writer.close();
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fovea/drive.h"
#include "fovea/drive/scans/dropped_points.h"
#include "fovea/drive/scans/intensity_scale.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/writers/generic_drive_writer.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"

namespace fovea {

struct DriveWriterFigures {
  std::size_t scans = 0;  ///< of all LiDARs
  std::size_t images = 0, poses = 0;
  DroppedPoints dropped;
};

/// Every function throws OutputError as GenericDriveWriter. Without close() nothing stays.
class AdapterWriter {
 public:
  /// std::invalid_argument for cameras of one name or number, LiDARs of one name, or a name that
  /// RecordedCamera or RecordedLidar does not allow.
  AdapterWriter(const std::filesystem::path& root, std::vector<RecordedCamera> cameras,
                const DriveWriterOptions& options = {});

  /// Adds the next frame, or nothing if it throws. Images belong to their stamps: a frame may have
  /// any number of them.
  /// @param T_world_lidar  pose at the scan's stamp, in any fixed frame; absent: not known
  /// std::invalid_argument for a stamp that is not after the one before (of the scans, or of the
  /// images of a camera), for a camera that the writer does not have, an image of another size, a
  /// column of another length than the positions, or a pose that is none. InputError if over 10 %
  /// of the points so far cannot be used (except with `allow_dropped`), for a scan without a usable
  /// point, and for an image file that is no PNG or JPEG, or damaged.
  void add(const DriveScan& scan, const std::vector<DriveImage>& images,
           const std::optional<RigidMotion>& T_world_lidar = std::nullopt);

  /// Adds a scan of a further LiDAR. It belongs to the frame that is nearest in time.
  /// @param scan  in the frame of that LiDAR
  /// std::invalid_argument for a LiDAR that the writer does not have, a stamp that is not after the
  /// one before, or a column of another length. InputError for a scan without a usable point.
  void add_scan(const std::string& lidar, const DriveScan& scan);

  /// Scans of the first LiDAR so far.
  std::size_t scans() const { return std::size_t(lidars_.at(drive_.lidar.name).scans); }

  /// Writes the tables, and gives the drive its name. std::logic_error without a scan, or if it is
  /// called again.
  DriveWriterFigures close();

 private:
  struct CameraState {
    RecordedCamera camera;
    std::optional<TimeNs> last;  // stamp
    int images = 0;
  };
  struct LidarState {
    std::optional<TimeNs> last;  // stamp
    int scans = 0;
    IntensityScale scale;
    DroppedPoints dropped;
    std::size_t kept = 0;
  };
  /// An image in its file's encoding.
  struct EncodedImage {
    std::vector<std::uint8_t> bytes;
    const char* extension;
  };
  CameraState& find_camera(const std::string& name);
  /// @param last  stamps of the images before, by camera
  void check_image(const DriveImage& image, std::map<std::string, TimeNs>& last);
  EncodedImage encoded(const DriveImage& image);
  void require_usable(const LidarState& lidar, const DriveScan& scan,
                      const LidarScan& usable) const;
  void write_scan(const std::string& name, LidarState& lidar, const DriveScan& scan);
  void write_image(const DriveImage& image, const EncodedImage& file);

  GenericDriveWriter writer_;
  bool allow_dropped_;
  RecordedDrive drive_;
  std::map<std::string, CameraState> cameras_;
  std::map<std::string, LidarState> lidars_;  // by name; of the only LiDAR it is empty
  DriveWriterFigures figures_;
  bool is_closed_ = false;
};

}  // namespace fovea
