#include "fovea/drive/frame_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "fovea/deskew.h"
#include "fovea/drive/lost_drive.h"
#include "fovea/errors.h"

namespace fovea {

void set_point_times(PointCloud& scan, bool is_compensated, const SweepTiming& sweep) {
  if (is_compensated) {
    scan.time.assign(scan.size(), 0);
  } else if (scan.time.empty()) {
    add_point_times(scan, sweep);
  }
}

std::optional<MissingImage> load_image(const Camera& camera, const ImageRectifier* rectifier,
                                       const std::string& name, const std::function<Image()>& read,
                                       Image& image) {
  const auto damaged = [&](std::string detail) {
    return MissingImage{camera.index, SkipReason::kDamagedImage, std::move(detail)};
  };
  try {
    Image as_taken = read();
    const int width = rectifier != nullptr ? rectifier->width() : camera.width,
              height = rectifier != nullptr ? rectifier->height() : camera.height;
    if (as_taken.width != width || as_taken.height != height) {
      return damaged(fmt::format("the image has {} x {} pixels, its camera {} x {}, {}",
                                 as_taken.width, as_taken.height, width, height, name));
    }
    image = rectifier != nullptr ? rectifier->rectify(as_taken) : std::move(as_taken);
    return std::nullopt;
  } catch (const DriveLostError&) {
    throw;
  } catch (const InputError& error) {
    return damaged(error.what());
  }
}

SkippedFrame frame_without_images(const Frame& frame) {
  std::vector<std::string> details;
  details.reserve(frame.missing_images.size());
  for (const MissingImage& image : frame.missing_images) details.push_back(image.detail);
  return {frame.index, frame.missing_images.front().reason,
          fmt::format("{}", fmt::join(details, "; "))};
}

}  // namespace fovea
