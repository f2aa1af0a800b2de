// A camera of drive.toml in use.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "fovea/core/messages.h"
#include "fovea/drive/drive_description.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/images/image_rectifier.h"
#include "fovea/drive/nearest_images.h"

namespace fovea {

struct DescribedCamera {
  Camera camera;                            ///< pinhole, with the delay that drive.toml states
  std::optional<ImageRectifier> rectifier;  ///< absent: images need none
};

/// ConfigError for a lens that leaves no image.
/// @param toml  the file, for the error
DescribedCamera described_camera(const CameraDescription& described,
                                 const std::filesystem::path& toml);

/// ConfigError if the first images that can be read all have another size than drive.toml states.
/// @param next   the next image; nothing after the last one; throws InputError for a damaged one
/// @param where  the images, for the error
void require_image_size(const CameraDescription& described,
                        const std::function<std::optional<Image>()>& next,
                        const std::filesystem::path& where);

/// Notes scans without an image, and images whose delays differ.
/// @param scans  their number
void note_matches(const CameraDescription& camera, const ImageMatches& matches, std::size_t scans,
                  double tolerance, Messages& messages);

/// The mask of a camera by the options, or else by drive.toml; absent: it has none.
/// @param folder  of the drive
std::optional<ImageMask> find_mask(const CameraDescription& described, const DescribedCamera& used,
                                   const DriveOptions& options,
                                   const std::filesystem::path& folder);

}  // namespace fovea
