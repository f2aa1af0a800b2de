// What the exports for view synthesis have in common: posed images, and points to begin with.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fovea/core/output_folder.h"
#include "fovea/exporting/views/point_thinner.h"
#include "fovea/exporting/views/posed_images.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// Points that Gaussian splatting begins with on a usual graphics card.
inline constexpr std::size_t kTrainingPoints = 500'000;
inline constexpr int kLeastTrainingPoints = 100, kMostTrainingPoints = 10'000'000;
inline constexpr double kLeastCell = 0.001;  // m
inline constexpr const char* kImageFolder = "images";

struct ViewExportOptions {
  PointChoice points = {};           ///< coordinates are local
  std::filesystem::path drive = {};  ///< its images are written, too; empty: none
  std::size_t max_points = kTrainingPoints;
  double cell = 0.05;  ///< m: of points in a cell of this edge the first one is kept
  bool force = false;
};

struct ViewExportFigures : ExportFigures {
  std::size_t thinned_out = 0;     ///< chosen points that are not written
  double cell = 0;                 ///< m, in the end
  std::size_t images = 0;          ///< with those held out
  std::size_t held_out = 0;        ///< images
  std::size_t images_missing = 0;  ///< not written: the drive does not have them
  std::vector<std::string> notes;  ///< what could not be compared between drive and map
};

struct ViewExport {
  std::vector<PosedImage> images;
  std::vector<PointThinner::Point> points;
  std::map<int, ImageMask> masks;  ///< of the drive, by number of the camera
  ViewExportFigures figures;
};

/// Gathers what an export writes, and writes the images of `options.drive`, if there is one, into
/// the folder. Then only frames of that drive are exported.
/// @param path  of the map
/// @throws InputError  if the map has no image, does not state its cameras, or is not of the drive
ViewExport gather_views(const MapReader& map, const std::filesystem::path& path,
                        const ViewExportOptions& options, const OutputFolder& folder);

/// What COLMAP and NeRF call the principal point: pixel centers are at 0.5 there.
Eigen::Vector2d principal_point_from_corner(const Camera& camera);

}  // namespace fovea
