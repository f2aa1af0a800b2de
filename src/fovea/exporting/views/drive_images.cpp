#include "fovea/exporting/views/drive_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"
#include "fovea/exporting/views/view_export.h"
#include "fovea/map/map_meta.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea {
namespace {

DriveMatch match_of(const MapReader& map, const FrameSource& drive,
                    const std::filesystem::path& path) {
  try {
    return match_drive(map, drive, path);
  } catch (const InputError& error) {
    // Images of another drive would not be where the poses are.
    throw InputError(error.problem(), error.where(), "give the drive that 'fovea info' names");
  }
}

Image with_three_channels(const Image& image) {
  if (image.channels == 3) return image;
  Image rgb(image.width, image.height, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    std::fill_n(&rgb.data[3 * i], 3, image.data[i]);
  }
  return rgb;
}

/// The image of a camera; nullptr if the frame has none.
const Image* find_image(const Frame& frame, const DriveInfo& drive, int camera) {
  const std::vector<Camera>& cameras = drive.calibration.cameras;
  for (std::size_t slot = 0; slot < std::min(cameras.size(), frame.images.size()); ++slot) {
    if (cameras[slot].index == camera && !frame.images[slot].empty()) return &frame.images[slot];
  }
  return nullptr;
}

/// Takes the size of the image, which not every calibration states.
void take_size(const Image& image, const DriveInfo& drive, PosedImage& posed) {
  Camera& camera = posed.camera;
  const bool is_known = camera.width > 0 && camera.height > 0;
  if (is_known && (camera.width != image.width || camera.height != image.height)) {
    throw InputError(
        fmt::format("the image of camera {} in frame {} has {}x{} pixels, not {}x{}", camera.index,
                    posed.frame, image.width, image.height, camera.width, camera.height),
        drive.path.string(), "give the drive as it was when the map was made");
  }
  camera.width = image.width, camera.height = image.height;
}

}  // namespace

DriveOfMap::DriveOfMap(const MapReader& map, const std::filesystem::path& path,
                       const std::filesystem::path& drive) {
  DriveOptions options;
  const MapMeta meta = map.meta();
  options.cameras = mapped_cameras(meta);
  drive_ = open_drive(drive, options);
  match_ = match_of(map, *drive_, path);
  if (has_stored_calibration(meta)) {
    drive_ = with_stored_calibration(std::move(drive_), meta, path);
  }
  drive_ = with_map_numbers(std::move(drive_), match_);
}

void DriveOfMap::add_cameras(CamerasOfDrives& cameras) const {
  for (const int drive : match_.drives) {
    cameras.try_emplace(std::size_t(drive), drive_->info().calibration.cameras);
  }
}

std::vector<PosedImage> DriveOfMap::write_images(const std::vector<PosedImage>& images,
                                                 const OutputFolder& folder) const {
  std::map<int, std::vector<std::size_t>> by_frame;
  for (std::size_t i = 0; i < images.size(); ++i) by_frame[images[i].frame].push_back(i);
  const std::vector<std::pair<int, std::vector<std::size_t>>> frames(by_frame.begin(),
                                                                     by_frame.end());
  std::vector<PosedImage> posed = images;
  std::vector<std::uint8_t> is_written(images.size(), 0);
  parallel_for(frames.size(), 1, [&](std::size_t k) {
    const LoadedFrame loaded = drive_->load(frames[k].first);
    const auto* frame = std::get_if<Frame>(&loaded);
    if (frame == nullptr) return;
    for (const std::size_t i : frames[k].second) {
      const Image* image = find_image(*frame, drive_->info(), posed[i].camera.index);
      if (image == nullptr) continue;
      take_size(*image, drive_->info(), posed[i]);
      const std::vector<std::uint8_t> png = encode_png(with_three_channels(*image));
      folder.write(std::filesystem::path(kImageFolder) / posed[i].file_name(),
                   {reinterpret_cast<const char*>(png.data()), png.size()});
      is_written[i] = 1;
    }
  });
  std::vector<PosedImage> written;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (is_written[i] != 0) written.push_back(posed[i]);
  }
  if (!written.empty()) return written;
  throw InputError("no image of the map's frames can be read", drive_->info().path.string(),
                   "give the drive that the map was made of");
}

}  // namespace fovea
