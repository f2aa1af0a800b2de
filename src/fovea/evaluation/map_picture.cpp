#include "fovea/evaluation/map_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/core/stable_order.h"
#include "fovea/errors.h"
#include "fovea/evaluation/drive_in_city.h"
#include "fovea/evaluation/evaluate_uncolored.h"
#include "fovea/evaluation/predicted_light.h"
#include "fovea/evaluation/scored_city.h"
#include "fovea/evaluation/scored_map.h"
#include "fovea/map/color_display.h"
#include "fovea/pipeline/drive_match.h"
#include "fovea/pipeline/stored_calibration.h"
#include "fovea/rendering/splat.h"
#include "fovea/rendering/viewpoint.h"

namespace fovea {
namespace {

struct PlacedCamera {
  Camera camera;
  RigidMotion T_local_cam;
};

constexpr std::array kViews{Viewpoint{"driver", 0, 0, 4 * kDegree, 80 * kDegree},
                            Viewpoint{"behind", 9, 5, 20 * kDegree, 75 * kDegree},
                            Viewpoint{"above", -6, 28, 88 * kDegree, 70 * kDegree}};

/// The frame asked for, or the middle one.
const FrameRecord& find_frame(const ScoredMap& map, int index, const std::filesystem::path& path) {
  if (map.frames.empty()) {
    throw InputError("the map has no frames", path.string(), "map a drive first");
  }
  if (index < 0) return map.frames[map.frames.size() / 2];
  for (const FrameRecord& frame : map.frames) {
    if (frame.index == index) return frame;
  }
  throw InputError(
      fmt::format("frame {} is not in the map", index), path.string(),
      fmt::format("give --frame {} to {}", map.frames.front().index, map.frames.back().index));
}

/// As exposed as the image of a frame, by the gain of the frame or of its neighbors.
ColorDisplay exposure_of(const FrameRecord& frame, int camera,
                         const std::vector<FrameRecord>& frames) {
  const ViewRecord* view = frame.find_view(camera);
  if (view != nullptr && view->log2_gain) return {view->light(), /*tone_mapped=*/false};
  const auto light = predicted_light(frames, frame.index, camera);
  return light ? ColorDisplay(*light, /*tone_mapped=*/false) : ColorDisplay();
}

SplatView draw(const ScoredMap& map, const Camera& camera, const RigidMotion& T_local_cam,
               const ColorDisplay& display) {
  const ColoredPoints points =
      has_colors(map) ? colored_points(map.points_local) : all_points(map.points_local);
  SplatOptions options;
  options.max_radius = 20;
  options.display = display;
  return splat(points, spacing_of(points, map.meta), camera, T_local_cam.inverse(), options);
}

/// A frame of the map with its scan and image.
using RecordedFrame = std::pair<FrameRecord, Frame>;

/// The frame asked for, or the one next to the middle that can be read.
RecordedFrame load_frame(const ScoredMap& map, const std::filesystem::path& path,
                         const PhotographedDrive& drive, int index) {
  std::vector<FrameRecord> records = {find_frame(map, index, path)};
  if (index < 0) {
    const int middle = records.front().index;
    records = map.frames;
    sort_stably(records, [&](const FrameRecord& a, const FrameRecord& b) {
      return std::abs(a.index - middle) < std::abs(b.index - middle);
    });
  }
  std::optional<SkippedFrame> first;
  for (FrameRecord& record : records) {
    LoadedFrame loaded = drive.source->load(record.index);
    if (auto* frame = std::get_if<Frame>(&loaded)) return {std::move(record), std::move(*frame)};
    if (!first) first = std::get<SkippedFrame>(loaded);
  }
  throw InputError(fmt::format("frame {} cannot be read ({})", first->index, first->detail),
                   drive.path.string(), "choose another --frame");
}

/// The map as one of the drive's cameras sees it, above the photograph that it took.
/// @param map  with the frames of the drive
Image above_photograph(const ScoredMap& map, const std::filesystem::path& path,
                       PhotographedDrive drive, const PictureOptions& options) {
  if (has_stored_calibration(map.meta)) {
    drive.source = with_stored_calibration(std::move(drive.source), map.meta, path);
  }
  require_cameras(drive.source->info(), "a picture beside a photograph");
  const auto [frame, loaded] = load_frame(map, path, drive, options.frame);
  const Camera camera = drive.source->info().camera_at(0, frame.index).at_image(frame.motion);
  const Image& photograph = loaded.images.at(0);
  const SplatView drawn =
      draw(map, camera, frame.T_local_lidar * camera.T_cam_lidar.inverse(),
           options.exposure.empty() ? exposure_of(frame, camera.index, map.frames)
                                    : color_display(parse_exposure(options.exposure), map.frames));
  Image both(camera.width, 2 * camera.height, 3);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      for (int c = 0; c < 3; ++c) {
        both.pixel(u, v)[c] = drawn.image.pixel(u, v)[c];
        both.pixel(u, camera.height + v)[c] =
            photograph.pixel(u, v)[photograph.channels == 3 ? c : 0];
      }
    }
  }
  return both;
}

/// Above the middle of a map, north up, so high that all of it is in view.
PlacedCamera above_map(const PointCloud& points, int width, int height) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : points.position) box.extend(points.origin + p.cast<double>());
  const Viewpoint view{"map", 0, 0, 0, 20 * kDegree};  // narrow: nearly without perspective
  const Camera camera = viewpoint_camera(view, width, height);
  const Eigen::Vector3d size = box.sizes();
  const double distance = camera.fx * std::max(size.x() / width, size.y() / height);
  constexpr double kMargin = 1.02;
  const Eigen::Vector3d middle = box.center();
  const Eigen::Vector3d eye(middle.x(), middle.y(),
                            box.max().z() + std::max(1.0, kMargin * distance));
  return {camera, pose_looking_at(eye, middle)};
}

PlacedCamera free_camera(const FreeView& view, int width, int height) {
  if (!view.from.allFinite() || !view.to.allFinite() || view.from == view.to) {
    throw ConfigError("the camera looks nowhere", "free_view", "give two different places");
  }
  const Viewpoint viewpoint{"free", 0, 0, 0, 75 * kDegree};
  return {viewpoint_camera(viewpoint, width, height), pose_looking_at(view.from, view.to)};
}

PlacedCamera placed_camera(const ScoredMap& map, const std::filesystem::path& path,
                           const PictureOptions& options) {
  const auto [width, height] = std::pair(options.width, options.height);
  if (options.free_view) return free_camera(*options.free_view, width, height);
  if (options.view == "map") return above_map(map.points_local, width, height);
  const FrameRecord& frame = find_frame(map, options.frame, path);
  const Viewpoint& view = *std::find_if(kViews.begin(), kViews.end(),
                                        [&](const Viewpoint& v) { return v.name == options.view; });
  return {viewpoint_camera(view, width, height), viewpoint_pose(view, frame.T_local_lidar)};
}

void check(const PictureOptions& options) {
  if (std::find(kPictureViews.begin(), kPictureViews.end(), options.view) == kPictureViews.end()) {
    throw ConfigError(fmt::format("there is no view '{}'", options.view), "view",
                      fmt::format("give one of {}", fmt::join(kPictureViews, ", ")));
  }
  for (const int side : {options.width, options.height}) {
    if (side >= kMinPictureSide && side <= kMaxPictureSide) continue;
    throw ConfigError(fmt::format("a picture cannot have {} pixels", side), "width or height",
                      fmt::format("give {} to {}", kMinPictureSide, kMaxPictureSide));
  }
}

}  // namespace

Image draw_map(const MapReader& map, const std::filesystem::path& path,
               const PictureOptions& options) {
  check(options);
  const ExposureChoice exposure =
      parse_exposure(options.exposure.empty() ? "auto" : options.exposure);
  const ScoredMap scored = load_scored_map(map);
  const auto [camera, T_local_cam] = placed_camera(scored, path, options);
  return draw(scored, camera, T_local_cam, color_display(exposure, scored.frames)).image;
}

Image draw_above_photograph(const MapReader& map, const std::filesystem::path& path,
                            PhotographedDrive drive, const PictureOptions& options) {
  ScoredMap scored = load_scored_map(map);
  if (!drive.foreign) {
    choose_frames(match_drive(map, *drive.source, path).number_in_drive, scored);
  }
  return above_photograph(scored, path, std::move(drive), options);
}

Image draw_above_photograph(const City& city, const std::filesystem::path& path,
                            PhotographedDrive drive, const PictureOptions& options) {
  const ScoredMap scored =
      load_scored_city(city, find_drive_in_city(city, *drive.source, drive.foreign));
  return above_photograph(scored, path, std::move(drive), options);
}

}  // namespace fovea
