#include "fovea/exporting/views/posed_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "fovea/errors.h"
#include "fovea/map/camera_models.h"

namespace fovea {
namespace {

/// Number of the drive of a frame; 0 in a map without drives.
std::size_t drive_of(int frame, const std::vector<DriveRecord>& drives) {
  const std::size_t drive = drive_of_frame(drives, frame);
  return drive == drives.size() ? 0 : drive;
}

const Camera& find_camera(const CamerasOfDrives& cameras, std::size_t drive, int index,
                          const std::filesystem::path& path) {
  if (const auto of_drive = cameras.find(drive); of_drive != cameras.end()) {
    for (const Camera& camera : of_drive->second) {
      if (camera.index == index) return camera;
    }
  }
  throw InputError(fmt::format("the map does not state its camera {}", index), path.string(),
                   "give the drive of the map with --drive, or map it again");
}

/// The views of a frame, and one for each camera that has none.
std::vector<ViewRecord> possible_views(const FrameRecord& frame, const CamerasOfDrives& cameras,
                                       std::size_t drive) {
  std::vector<ViewRecord> views = frame.views;
  const auto of_drive = cameras.find(drive);
  if (of_drive == cameras.end()) return views;
  for (const Camera& camera : of_drive->second) {
    if (frame.find_view(camera.index) == nullptr) views.push_back({camera.index, std::nullopt});
  }
  return views;
}

/// The image of a view, by the camera's own moment where the map states both stamps.
PosedImage posed_image(const FrameRecord& frame, const ViewRecord& view, std::size_t drive,
                       Camera camera) {
  if (view.stamp && frame.stamp) camera.image_delay = seconds(*view.stamp - *frame.stamp);
  PosedImage image;
  image.frame = frame.index;
  image.drive = drive;
  image.camera = camera.at_image(frame.motion);
  image.T_cam_local = image.camera.T_cam_lidar * frame.T_local_lidar.inverse();
  image.is_held_out = frame.status == FrameStatus::kHeldOut;
  return image;
}

}  // namespace

std::string PosedImage::file_name() const {
  return fmt::format("camera_{}_{:010}.png", camera.index, frame);
}

CamerasOfDrives stated_cameras(const MapReader& map) {
  const MapMeta meta = map.meta();
  const std::size_t drives = std::max<std::size_t>(1, map.drives().size());
  CamerasOfDrives cameras;
  for (std::size_t drive = 0; drive < drives; ++drive) {
    std::vector<Camera> of_drive = camera_models(meta, drive);
    if (!of_drive.empty()) cameras[drive] = std::move(of_drive);
  }
  return cameras;
}

std::vector<PosedImage> posed_images(const MapReader& map, const CamerasOfDrives& cameras,
                                     ImageChoice choice, const std::filesystem::path& path) {
  const std::vector<DriveRecord> drives = map.drives();
  std::vector<PosedImage> images;
  for (const FrameRecord& frame : map.frames()) {
    if (frame.status == FrameStatus::kSkipped) continue;
    const std::size_t drive = drive_of(frame.index, drives);
    const std::vector<ViewRecord> views =
        choice == ImageChoice::kPossible ? possible_views(frame, cameras, drive) : frame.views;
    for (const ViewRecord& view : views) {
      const Camera& camera = find_camera(cameras, drive, view.camera, path);
      images.push_back(posed_image(frame, view, drive, camera));
    }
  }
  if (images.empty()) {
    throw InputError("the map has no frame with an image", path.string(),
                     "give the drive of the map with --drive, or map a drive with images");
  }
  std::sort(images.begin(), images.end(), [](const PosedImage& a, const PosedImage& b) {
    return std::tuple(a.camera.index, a.frame) < std::tuple(b.camera.index, b.frame);
  });
  return images;
}

}  // namespace fovea
