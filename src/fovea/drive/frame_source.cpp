#include "fovea/drive/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "fovea/errors.h"

namespace fovea {

const char* to_string(SkipReason reason) {
  switch (reason) {
    case SkipReason::kMissingScan:
      return "missing scan";
    case SkipReason::kDamagedScan:
      return "damaged scan";
    case SkipReason::kMissingImage:
      return "missing image";
    case SkipReason::kDamagedImage:
      return "damaged image";
    case SkipReason::kMissingStamp:
      return "missing time stamp";
  }
  return "unknown";
}

double DriveInfo::image_offset(std::size_t slot, int index) const {
  if (!image_stamps_are_capture_times || slot >= image_offsets.size()) return 0;
  const auto found = image_offsets[slot].find(index);
  return found == image_offsets[slot].end() ? 0 : found->second;
}

std::vector<int> DriveInfo::frame_indices() const {
  if (!frames.empty()) return frames;
  std::vector<int> all(frame_count());
  std::iota(all.begin(), all.end(), begin);
  return all;
}

std::size_t DriveInfo::frame_count() const {
  return frames.empty() ? static_cast<std::size_t>(std::max(0, end - begin)) : frames.size();
}

bool DriveInfo::has_image_delays() const {
  const auto is_delayed = [](const Camera& camera) { return camera.image_delay != 0; };
  const auto differs = [](const std::map<int, double>& offsets) {
    return std::any_of(offsets.begin(), offsets.end(), [](const auto& o) { return o.second != 0; });
  };
  return std::any_of(calibration.cameras.begin(), calibration.cameras.end(), is_delayed) ||
         std::any_of(image_offsets.begin(), image_offsets.end(), differs);
}

std::optional<double> DriveInfo::image_exposure(int camera, int index) const {
  for (std::size_t slot = 0; slot < image_exposures.size(); ++slot) {
    if (calibration.cameras[slot].index != camera) continue;
    const auto found = image_exposures[slot].find(index);
    if (found != image_exposures[slot].end()) return found->second;
  }
  return std::nullopt;
}

const ImageMask* DriveInfo::mask(int camera) const {
  const auto found = masks.find(camera);
  return found == masks.end() ? nullptr : &found->second;
}

Camera DriveInfo::camera_at(std::size_t slot, int index) const {
  Camera camera = calibration.cameras.at(slot);
  camera.image_delay += image_offset(slot, index);
  return camera;
}

Camera camera_of(const DriveInfo& drive, const Frame& frame, std::size_t slot) {
  Camera camera = drive.calibration.cameras.at(slot);
  if (slot < frame.image_offsets.size()) camera.image_delay += frame.image_offsets[slot];
  return camera;
}

void require_cameras(const DriveInfo& drive, std::string_view purpose) {
  if (!drive.calibration.cameras.empty()) return;
  throw InputError(fmt::format("the drive has no camera, which {} needs", purpose),
                   drive.path.string(), "give a drive with images and their calibration");
}

}  // namespace fovea
