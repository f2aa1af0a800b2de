// Pictures of a map: of `fovea render`, and of Map.render() in Python.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/city/city.h"
#include "fovea/drive/frame_source.h"
#include "fovea/image.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Places around the vehicle, and all of the map from above.
inline constexpr std::array<std::string_view, 4> kPictureViews = {"driver", "behind", "above",
                                                                  "map"};
inline constexpr int kMinPictureSide = 16, kMaxPictureSide = 8192;

/// A camera at a place of the frame `local` that looks to another place, m.
struct FreeView {
  Eigen::Vector3d from, to;
};

struct PictureOptions {
  std::string view = "behind";             ///< one of kPictureViews
  std::optional<FreeView> free_view = {};  ///< instead of `view`
  int frame = -1;                          ///< where the vehicle was; -1: half way
  int width = 1280, height = 720;          ///< pixels
  std::string exposure = {};  ///< as parse_exposure(); empty: as the photograph, or auto
};

/// A picture of a map from one place.
/// @param path  of the map, for errors
/// @throws ConfigError  for a view, a size or an exposure that there is not
/// @throws InputError   if the map is damaged, or lacks the frame
Image draw_map(const MapReader& map, const std::filesystem::path& path,
               const PictureOptions& options);

/// A drive whose photograph a picture is compared with.
struct PhotographedDrive {
  std::unique_ptr<FrameSource> source;  ///< with the camera to draw alone
  std::filesystem::path path;           ///< for errors
  bool foreign = false;                 ///< the map need not be of the drive
};

/// The map as a camera of a drive sees it, above the photograph that the camera took. Of the
/// options, `frame` and `exposure` count.
/// @throws ConfigError  for an exposure that there is not, and a drive without cameras
/// @throws InputError   if the map is damaged, is not of the drive, or lacks the frame
Image draw_above_photograph(const MapReader& map, const std::filesystem::path& path,
                            PhotographedDrive drive, const PictureOptions& options);
/// The same of a city, of which only the tiles around the drive are read.
Image draw_above_photograph(const City& city, const std::filesystem::path& path,
                            PhotographedDrive drive, const PictureOptions& options);

}  // namespace fovea
