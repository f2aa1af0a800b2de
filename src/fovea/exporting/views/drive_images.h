// The images of a map's drive, as files of their own.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fovea/core/output_folder.h"
#include "fovea/drive/frame_source.h"
#include "fovea/exporting/views/posed_images.h"
#include "fovea/pipeline/drive_match.h"

namespace fovea {

/// A drive that a map was made of, with the frame numbers of the map.
class DriveOfMap {
 public:
  /// @throws InputError  if the map was not made of the drive
  DriveOfMap(const MapReader& map, const std::filesystem::path& path,
             const std::filesystem::path& drive);

  /// Adds the cameras of the drive where the map does not state them: as it was mapped with, also
  /// if the calibration was corrected.
  void add_cameras(CamerasOfDrives& cameras) const;
  /// Whether a frame of the map is one of the drive.
  bool has(int frame) const { return match_.number_in_drive.contains(frame); }
  const std::vector<std::string>& notes() const { return match_.notes; }
  /// Pixels that show no scene, by number of the camera.
  const std::map<int, ImageMask>& masks() const { return drive_->info().masks; }

  /// Writes the images, undistorted and with three channels, as images/NAME.
  /// @return those that the drive has, with the size of the image
  /// @throws InputError  if it has none, or one of another size than its camera
  std::vector<PosedImage> write_images(const std::vector<PosedImage>& images,
                                       const OutputFolder& folder) const;

 private:
  std::unique_ptr<FrameSource> drive_;
  DriveMatch match_;
};

}  // namespace fovea
