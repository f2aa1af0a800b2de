// fovea render: a picture of a map, or a whole drive through it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/html_report/viewpoint.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/render_drive.h"
#include "app/render_views.h"
#include "fovea/city/city.h"
#include "fovea/core/angle.h"
#include "fovea/core/output_file.h"
#include "fovea/core/stable_order.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"
#include "fovea/evaluation/drive_in_city.h"
#include "fovea/evaluation/evaluate_uncolored.h"
#include "fovea/evaluation/predicted_light.h"
#include "fovea/evaluation/scored_city.h"
#include "fovea/evaluation/scored_map.h"
#include "fovea/geometry/lidar_data_sheet.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/stored_calibration.h"
#include "fovea/rendering/splat.h"

namespace fovea::app {
namespace {

struct RenderArguments {
  RenderDriveArguments path;  // with --poses
  std::string map, drive, output, view = "behind";
  std::string camera = "2";
  std::string exposure;  // empty: as the photograph, without one as auto
  std::string from, to;  // places of a free camera
  int frame = -1, width = 1280, height = 720;
  bool force = false, foreign = false;
};

constexpr std::array kViews{Viewpoint{"driver", 0, 0, 4 * kDegree, 80 * kDegree},
                            Viewpoint{"behind", 9, 5, 20 * kDegree, 75 * kDegree},
                            Viewpoint{"above", -6, 28, 88 * kDegree, 70 * kDegree}};

/// The frame asked for, or the middle one.
const FrameRecord& find_frame(const ScoredMap& map, int index, const std::string& path) {
  if (map.frames.empty()) {
    throw InputError("the map has no frames", path, "map a drive first");
  }
  if (index < 0) return map.frames[map.frames.size() / 2];
  for (const FrameRecord& frame : map.frames) {
    if (frame.index == index) return frame;
  }
  throw InputError(
      fmt::format("frame {} is not in the map", index), path,
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
RecordedFrame load_frame(const RenderArguments& arguments, const ScoredMap& map,
                         const FrameSource& drive) {
  std::vector<FrameRecord> records = {find_frame(map, arguments.frame, arguments.map)};
  if (arguments.frame < 0) {
    const int middle = records.front().index;
    records = map.frames;
    sort_stably(records, [&](const FrameRecord& a, const FrameRecord& b) {
      return std::abs(a.index - middle) < std::abs(b.index - middle);
    });
  }
  std::optional<SkippedFrame> first;
  for (FrameRecord& record : records) {
    LoadedFrame loaded = drive.load(record.index);
    if (auto* frame = std::get_if<Frame>(&loaded)) return {std::move(record), std::move(*frame)};
    if (!first) first = std::get<SkippedFrame>(loaded);
  }
  throw InputError(fmt::format("frame {} cannot be read ({})", first->index, first->detail),
                   arguments.drive, "choose another --frame");
}

/// The map as one of the drive's cameras sees it, above the photograph that it took.
/// @param map  with the frames of the drive
Image above_photograph(const RenderArguments& arguments, const ScoredMap& map,
                       std::unique_ptr<FrameSource> drive) {
  if (has_stored_calibration(map.meta)) {
    drive = with_stored_calibration(std::move(drive), map.meta, arguments.map);
  }
  require_cameras(drive->info(), "a picture beside a photograph");
  const auto [frame, loaded] = load_frame(arguments, map, *drive);
  const Camera camera = drive->info().camera_at(0, frame.index).at_image(frame.motion);
  const Image& photograph = loaded.images.at(0);
  const SplatView drawn = draw(map, camera, frame.T_local_lidar * camera.T_cam_lidar.inverse(),
                               arguments.exposure.empty()
                                   ? exposure_of(frame, camera.index, map.frames)
                                   : color_display(parse_exposure(arguments.exposure), map.frames));
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

Image from_view(const RenderArguments& arguments, const ScoredMap& map) {
  const auto placed = [&]() -> PlacedCamera {
    if (!arguments.from.empty())
      return free_camera(arguments.from, arguments.to, arguments.width, arguments.height);
    if (arguments.view == "map")
      return above_map(map.points_local, arguments.width, arguments.height);
    const FrameRecord& frame = find_frame(map, arguments.frame, arguments.map);
    const Viewpoint& view = *std::find_if(
        kViews.begin(), kViews.end(), [&](const Viewpoint& v) { return v.name == arguments.view; });
    return {viewpoint_camera(view, arguments.width, arguments.height),
            viewpoint_pose(view, frame.T_local_lidar)};
  }();
  return draw(
             map, placed.camera, placed.T_local_cam,
             color_display(parse_exposure(arguments.exposure.empty() ? "auto" : arguments.exposure),
                           map.frames))
      .image;
}

/// What would otherwise be ignored without a word.
void check_options(const CLI::App& command, const RenderArguments& arguments) {
  const bool drive = command.count("--poses") > 0;
  if (is_city(arguments.map) && (drive || arguments.drive.empty())) {
    throw ConfigError("of a city only pictures with DRIVE are made, without --poses", arguments.map,
                      "give one of its drives, or a tile");
  }
  for (const char* option : {"--view", "--frame", "--width", "--height", "--from", "--to"}) {
    if (drive && command.count(option) > 0) {
      throw CLI::ValidationError(option, "is for a single picture, without --poses");
    }
  }
  for (const char* option : {"--cameras", "--lidar", "--rate", "--reach", "--threads", "--quiet"}) {
    if (!drive && command.count(option) > 0) throw CLI::ValidationError(option, "needs --poses");
  }
}

CommandFiles files_of(const RenderArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.map, arguments.drive, arguments.path.poses, arguments.camera};
  if (arguments.path.poses.empty()) {
    files.outputs = {{arguments.output, ContentKind::kPng, arguments.force}};
  } else {
    files.folder = {arguments.output};
  }
  return files;
}

Image picture_of_map(const RenderArguments& arguments) {
  const MapReader reader = open_map(arguments.map);
  ScoredMap map = load_scored_map(reader);
  if (arguments.drive.empty()) return from_view(arguments, map);
  auto drive = DriveArguments{arguments.drive, "", arguments.camera, {}}.open();
  const auto match =
      find_drive_in_map(reader, arguments.map, *drive, arguments.foreign, /*quiet=*/true);
  if (match) choose_frames(match->number_in_drive, map);
  return above_photograph(arguments, map, std::move(drive));
}

/// Only the tiles around the drive are read.
Image picture_of_city(const RenderArguments& arguments) {
  const City city = open_city(arguments.map);
  auto drive = DriveArguments{arguments.drive, "", arguments.camera, {}}.open();
  const ScoredMap map = load_scored_city(city, find_drive_in_city(city, *drive, arguments.foreign));
  return above_photograph(arguments, map, std::move(drive));
}

void run(const RenderArguments& arguments) {
  OutputFile output(arguments.output, arguments.force);
  const std::vector<std::uint8_t> png =
      encode_png(is_city(arguments.map) ? picture_of_city(arguments) : picture_of_map(arguments));
  output.stream().write(reinterpret_cast<const char*>(png.data()),
                        static_cast<std::streamsize>(png.size()));
  output.commit();
}

}  // namespace

void add_render_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Draw a picture of a map");
  command->add_option("MAP", arguments->map, "Map file; with DRIVE also a city")->required();
  command->add_option("DRIVE", arguments->drive,
                      "Draw what a camera of this drive sees, above its photograph");
  command->add_option("-o,--output", arguments->output, "Picture to write, or with --poses a drive")
      ->required()
      ->type_name("OUT.png|DIR");
  command
      ->add_option("--camera", arguments->camera,
                   "Camera of DRIVE; with --poses calib (all of DRIVE's), W,H,fx,fy,cx,cy, or a "
                   "drive or calibration folder")
      ->capture_default_str();
  CLI::Option* view =
      command
          ->add_option("--view", arguments->view,
                       "Without DRIVE: driver, behind or above the vehicle, or map: all of it from "
                       "above")
          ->capture_default_str()
          ->check(CLI::IsMember({"driver", "behind", "above", "map"}));
  CLI::Option* from =
      command
          ->add_option("--from", arguments->from,
                       "Without DRIVE: a free camera at this place of the local frame, m")
          ->type_name("X,Y,Z")
          ->excludes(view);
  CLI::Option* to = command->add_option("--to", arguments->to, "Where the free camera looks")
                        ->type_name("X,Y,Z")
                        ->needs(from);
  from->needs(to);
  command->add_option("--frame", arguments->frame, "From where the vehicle was (default: half way)")
      ->check(whole_number(0))
      ->excludes(from);
  command->add_option("--width", arguments->width, "Pixels")
      ->capture_default_str()
      ->check(whole_number(16, 8192));
  command->add_option("--height", arguments->height, "Pixels")
      ->capture_default_str()
      ->check(whole_number(16, 8192));
  command->add_option("--exposure", arguments->exposure,
                      "Of the colors: auto (the median exposure of the images), frame:N, or stops "
                      "above the exposure of the map (default: that of the photograph, else auto)");
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  add_foreign_option(*command, arguments->foreign);
  RenderDriveArguments& path = arguments->path;
  command->add_option("--poses", path.poses,
                      "Render a drive: images, depth and scans at each pose T_local_lidar of this "
                      "file (docs/rendering.md)");
  command->add_option(
      "--cameras", path.cameras,
      "Which of the cameras there (default: those that map takes; all of a calibration folder)");
  command
      ->add_option("--lidar", path.lidar,
                   fmt::format("Scans, too, of one of {}", fmt::join(lidar_model_names(), ", ")))
      ->check(CLI::IsMember(lidar_model_names()));
  command->add_option("--rate", path.rate, "Frames a second")
      ->capture_default_str()
      ->check(finite_range(0.1, 1000));
  command->add_option("--reach", path.reach, "How far is seen, m")
      ->capture_default_str()
      ->check(finite_range(1, 1000));
  command->add_option("--threads", path.threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--quiet", path.quiet, "Say nothing but errors");
  command->callback([arguments, command, &session] {
    check_options(*command, *arguments);
    check_files(files_of(*arguments));
    RenderDriveArguments& drive = arguments->path;
    if (drive.poses.empty()) return run(*arguments);
    drive.map = arguments->map;
    drive.output = arguments->output;
    if (command->count("--camera") > 0) drive.camera = arguments->camera;
    drive.drive = arguments->drive;
    drive.force = arguments->force;
    drive.foreign = arguments->foreign;
    if (!arguments->exposure.empty()) drive.exposure = parse_exposure(arguments->exposure);
    render_drive_command(drive, session.warnings);
  });
}

}  // namespace fovea::app
