#include "fovea/exporting/views/view_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fovea/errors.h"
#include "fovea/exporting/views/drive_images.h"

namespace fovea {
namespace {

void require_sizes(const std::vector<PosedImage>& images, const std::filesystem::path& path) {
  for (const PosedImage& image : images) {
    if (image.camera.width > 0 && image.camera.height > 0) continue;
    throw InputError(fmt::format("the size of camera {} is not known", image.camera.index),
                     path.string(), "give the drive of the map with --drive");
  }
}

void gather_points(const MapReader& map, const ViewExportOptions& options, ViewExport& views) {
  const PointStream stream(map, options.points);
  static_cast<ExportFigures&>(views.figures) = stream.figures();
  PointThinner thinner(options.cell, options.max_points);
  stream.for_each_block([&](std::span<const ExportPoint> block) {
    for (const ExportPoint& point : block) thinner.add({point.position, point.color});
  });
  views.points = thinner.points();
  views.figures.thinned_out = views.figures.points - views.points.size();
  views.figures.points = views.points.size();
  views.figures.cell = thinner.cell();
}

}  // namespace

ViewExport gather_views(const MapReader& map, const std::filesystem::path& path,
                        const ViewExportOptions& options, const OutputFolder& folder) {
  if (options.points.crs != Crs::kLocal) {
    throw std::invalid_argument("posed images are in the local frame of the map");
  }
  const auto held_state = map.hold_state();
  ViewExport views;
  CamerasOfDrives cameras = stated_cameras(map);
  if (options.drive.empty()) {
    views.images = posed_images(map, cameras, ImageChoice::kStated, path);
  } else {
    const DriveOfMap drive(map, path, options.drive);
    drive.add_cameras(cameras);
    std::vector<PosedImage> images = posed_images(map, cameras, ImageChoice::kPossible, path);
    std::erase_if(images, [&](const PosedImage& image) { return !drive.has(image.frame); });
    views.images = drive.write_images(images, folder);
    views.figures.images_missing = images.size() - views.images.size();
    views.masks = drive.masks();
    views.figures.notes = drive.notes();
  }
  require_sizes(views.images, path);
  views.figures.images = views.images.size();
  views.figures.held_out =
      std::size_t(std::count_if(views.images.begin(), views.images.end(),
                                [](const PosedImage& image) { return image.is_held_out; }));
  gather_points(map, options, views);
  return views;
}

Eigen::Vector2d principal_point_from_corner(const Camera& camera) {
  return {camera.cx + 0.5, camera.cy + 0.5};
}

}  // namespace fovea
