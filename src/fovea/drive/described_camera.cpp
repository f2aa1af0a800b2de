#include "fovea/drive/described_camera.h"

#include <fmt/format.h>

#include "fovea/drive/drive_files.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/errors.h"
#include "fovea/geometry/rectified_camera.h"

namespace fovea {
namespace {

constexpr double kNotableSpread = 0.001;  // s, of an image's delay: 1 cm at 10 m/s

}  // namespace

DescribedCamera described_camera(const CameraDescription& described,
                                 const std::filesystem::path& toml) {
  const auto pinhole =
      rectified_camera(described.optics, described.max_field_of_view, kMaxImageSide);
  const bool distorted = described.optics.lens.model() != LensModel::kNone;
  std::optional<ImageRectifier> rectifier;
  if (distorted && pinhole) rectifier = ImageRectifier::make(described.optics, *pinhole);
  if (!pinhole || (distorted && !rectifier)) {
    throw ConfigError(
        fmt::format("the lens of camera {} leaves no image, or one too large", described.name),
        toml.string(), "check K and D, or lower its field_of_view");
  }
  Camera camera = *pinhole;
  camera.index = described.index;
  camera.T_cam_lidar = described.T_cam_lidar;
  camera.image_delay = described.delay;
  return {camera, std::move(rectifier)};
}

void require_image_size(const CameraDescription& described,
                        const std::function<std::optional<Image>()>& next,
                        const std::filesystem::path& where) {
  constexpr int kLookedAt = 10;
  std::string found = "cannot be read";
  for (int i = 0; i < kLookedAt; ++i) {
    try {
      const std::optional<Image> image = next();
      if (!image) break;
      if (image->width == described.optics.width && image->height == described.optics.height) {
        return;
      }
      found = fmt::format("have {} x {} pixels, not {} x {}", image->width, image->height,
                          described.optics.width, described.optics.height);
    } catch (const InputError&) {
      continue;  // reported when the image is loaded
    }
  }
  throw ConfigError(fmt::format("the images of camera {} {}", described.name, found),
                    where.string(), "give their width and height in drive.toml, or restore them");
}

void note_matches(const CameraDescription& camera, const ImageMatches& matches, std::size_t scans,
                  double tolerance, Messages& messages) {
  if (matches.image_of_scan.size() < scans) {
    messages.warn(fmt::format("camera {} ({}) has no image within {:g} s of {} of {} scans",
                              camera.index, camera.name, tolerance,
                              scans - matches.image_of_scan.size(), scans));
  }
  if (matches.max_delay - matches.min_delay > kNotableSpread) {
    messages.notes.push_back(fmt::format(
        "camera {} ({}) takes images {:.1f} to {:.1f} ms after the scans; each is projected at "
        "its own time",
        camera.index, camera.name, 1e3 * matches.min_delay, 1e3 * matches.max_delay));
  }
}

std::optional<ImageMask> find_mask(const CameraDescription& described, const DescribedCamera& used,
                                   const DriveOptions& options,
                                   const std::filesystem::path& folder) {
  const auto asked = options.masks.find(described.index);
  const std::filesystem::path mask = asked != options.masks.end() ? asked->second
                                     : described.mask.empty()     ? std::filesystem::path()
                                                                  : folder / described.mask;
  if (mask.empty()) return std::nullopt;
  return read_mask(mask, used.camera, used.rectifier ? &*used.rectifier : nullptr);
}

}  // namespace fovea
