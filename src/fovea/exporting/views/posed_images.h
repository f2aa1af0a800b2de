// The images of a map's frames, and where the cameras were that took them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/camera.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// An image that a camera of a drive took.
struct PosedImage {
  int frame = 0;          ///< its number in the map
  std::size_t drive = 0;  ///< number of the drive in the map
  /// Without distortion; where it was when it took the image, as Camera::at_image().
  Camera camera;
  RigidMotion T_cam_local = RigidMotion::Identity();
  bool is_held_out = false;  ///< the map has nothing of it

  /// Name of its file: "camera_2_0000000012.png". It begins with the camera, so that the images of
  /// a camera follow each other in a sorted folder.
  std::string file_name() const;
};

/// Cameras by the number of the drive in the map.
using CamerasOfDrives = std::map<std::size_t, std::vector<Camera>>;

/// The cameras that a map states; a drive without them is absent.
CamerasOfDrives stated_cameras(const MapReader& map);

/// Which images the frames of a map have.
enum class ImageChoice {
  kStated,   ///< those of the views that the map states
  kPossible  ///< one of each camera: maps of format 6 do not state views
};

/// The images of the frames that have a pose of their own, by camera and frame.
/// @param path  of the map, for errors
/// @throws InputError  if there is none, or if the cameras of its drive are not known
std::vector<PosedImage> posed_images(const MapReader& map, const CamerasOfDrives& cameras,
                                     ImageChoice choice, const std::filesystem::path& path);

}  // namespace fovea
