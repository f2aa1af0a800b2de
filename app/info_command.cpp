// fovea info: what a map or a city holds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/city_info.h"
#include "app/commands.h"
#include "app/map_arguments.h"
#include "app/print.h"
#include "app/sensor_text.h"
#include "fovea/city/city.h"
#include "fovea/core/angle.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/sensor_json.h"

namespace fovea::app {
namespace {

struct InfoArguments {
  std::string map;
  bool json = false, digest = false, check = false;
};

struct Contents {
  MapMeta meta;
  std::vector<MergedDrive> drives;  // of a merged map
  std::vector<SensorRecord> sensors;
  std::size_t points = 0, submaps = 0, tiles = 0;
  bool has(const char* key) const { return meta.contains(key); }
  /// Nothing if a repaired map has lost the key.
  std::optional<bool> is_complete() const {
    const auto complete = meta.find(meta_key::kComplete);
    if (complete == meta.end() && has(meta_key::kRepair)) return std::nullopt;
    return complete != meta.end() && complete->second == "1";
  }
  int mapped = 0, held_out = 0, skipped = 0;
  double path_length = 0;  // m, along the refined poses
  Eigen::AlignedBox3d bounds_local;
};

Contents read_contents(const MapReader& reader) {
  Contents contents;
  contents.meta = reader.meta();
  contents.points = reader.size();
  const FrameRecord* before = nullptr;
  const std::vector<FrameRecord> frames = reader.frames();
  contents.drives = merged_drives(reader);
  contents.sensors = reader.sensors();
  const auto begins_a_drive = [&](const FrameRecord& frame) {
    return std::any_of(contents.drives.begin(), contents.drives.end(),
                       [&](const MergedDrive& d) { return d.first_frame == frame.index; });
  };
  for (const FrameRecord& frame : frames) {
    contents.mapped += frame.status == FrameStatus::kMapped;
    contents.held_out += frame.status == FrameStatus::kHeldOut;
    contents.skipped += frame.status == FrameStatus::kSkipped;
    if (before != nullptr && !begins_a_drive(frame)) {
      contents.path_length +=
          (frame.T_local_lidar.translation() - before->T_local_lidar.translation()).norm();
    }
    before = &frame;
  }
  const std::vector<RigidMotion> submaps = reader.submaps();
  contents.submaps = submaps.size();
  reader.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    ++contents.tiles;
    for (const Eigen::Vector3f& p : tile.position) {
      contents.bounds_local.extend(submaps[submap] * (tile.origin + p.cast<double>()));
    }
  });
  return contents;
}

/// " (repaired, unfinished)"; empty for a complete map of a drive.
std::string state_of(const Contents& c) {
  std::vector<std::string> states;
  if (c.has(meta_key::kRepair)) states.emplace_back("repaired");
  if (c.has(meta_key::kCrop)) states.emplace_back("cropped");
  if (!c.drives.empty()) states.emplace_back("merged");
  if (c.is_complete() == false) {
    // Only such a map can be resumed.
    states.emplace_back(states.empty() ? "unfinished: --resume goes on" : "unfinished");
  }
  return states.empty() ? "" : fmt::format(" ({})", fmt::join(states, ", "));
}

void print_text(const Contents& c, const std::string& path) {
  const auto meta = [&](const char* key) {
    const auto found = c.meta.find(key);
    return found != c.meta.end() ? found->second : std::string();
  };
  print_out("{}{}\n", path, state_of(c));
  const std::string cameras =
      meta(meta_key::kCameras).empty() ? "no camera" : "cameras " + meta(meta_key::kCameras);
  print_out("  drive      {} ({}), frames {} to {}, {}\n", meta(meta_key::kDriveName),
            meta(meta_key::kDriveKind), meta(meta_key::kFramesBegin),
            std::stoi("0" + meta(meta_key::kFramesEnd)) - 1, cameras);
  for (const MergedDrive& d : c.drives) {
    print_out("  merged     {}: frames {} to {}, in the drive {} to {}\n", d.name, d.first_frame,
              d.end_frame - 1, d.first_frame - d.frame_shift, d.end_frame - 1 - d.frame_shift);
  }
  print_out("  frames     {} mapped, {} held out{}, {} skipped\n", c.mapped, c.held_out,
            meta(meta_key::kHoldOut).empty() ? "" : " (" + meta(meta_key::kHoldOut) + ")",
            c.skipped);
  for (const SensorRecord& sensor : c.sensors) {
    print_out("  LiDAR      {}: {}\n", sensor.profile.name, to_text(sensor.profile));
  }
  print_out("  points     {} in {} tiles of {} submaps\n", c.points, c.tiles, c.submaps);
  if (!c.bounds_local.isEmpty()) {
    const Eigen::Vector3d size = c.bounds_local.sizes();
    print_out("  extent     {:.1f} x {:.1f} x {:.1f} m, path {:.1f} m\n", size.x(), size.y(),
              size.z(), c.path_length);
  }
  if (meta(meta_key::kGeoreferenced) == "1") {
    print_out("  origin     {} N, {} E, {} m (WGS84; axes east, north, up)\n",
              meta(meta_key::kOriginLatitude), meta(meta_key::kOriginLongitude),
              meta(meta_key::kOriginHeight));
  } else {
    print_out("  origin     not georeferenced: the first scan's own axes\n");
  }
  for (const char* key : {meta_key::kCrop, meta_key::kRepair}) {
    if (!meta(key).empty()) print_out("  {:<10} {}\n", key, meta(key));
  }
  if (!meta(meta_key::kVariant).empty()) print_out("  variant    {}\n", meta(meta_key::kVariant));
  if (!meta(meta_key::kNotes).empty()) print_out("  notes      {}\n", meta(meta_key::kNotes));
  print_out("\n");
  print_lines(meta(meta_key::kConfig));
}

std::vector<std::string> warnings_of(const Contents& c) {
  std::vector<std::string> warnings = warnings_of_map(c.meta);
  if (c.skipped > 0) warnings.push_back(fmt::format("{} frames were skipped", c.skipped));
  return warnings;
}

void print_json(const Contents& c) {
  nlohmann::ordered_json json{{"meta", c.meta},
                              {"complete", nullptr},
                              {"repaired", c.has(meta_key::kRepair)},
                              {"cropped", c.has(meta_key::kCrop)},
                              {"merged", !c.drives.empty()},
                              {"points", c.points},
                              {"tiles", c.tiles},
                              {"submaps", c.submaps},
                              {"frames", c.mapped},
                              {"frames_held_out", c.held_out},
                              {"frames_skipped", c.skipped},
                              {"path_length_m", c.path_length}};
  if (const auto complete = c.is_complete()) json["complete"] = *complete;
  for (const MergedDrive& drive : c.drives) {
    json["drives"].push_back({{"name", drive.name},
                              {"first_frame", drive.first_frame},
                              {"end_frame", drive.end_frame},
                              {"frame_shift", drive.frame_shift}});
  }
  for (const SensorRecord& sensor : c.sensors) {
    json["sensors"].push_back(nlohmann::ordered_json::parse(to_json(sensor.profile)));
  }
  if (!c.bounds_local.isEmpty()) {
    const auto corner = [](const Eigen::Vector3d& v) { return std::vector{v.x(), v.y(), v.z()}; };
    json["bounds_local"] = {{"min", corner(c.bounds_local.min())},
                            {"max", corner(c.bounds_local.max())}};
  }
  json["warnings"] = warnings_of(c);
  print_json_value(json);
}

/// Names each part of a map that cannot be read; InputError if there is one.
void check(const std::string& path) {
  std::size_t damages = 0;
  const MapReader reader(path, [&](const std::string& damage) {
    ++damages;
    print_out("{}\n", damage);
  });
  const std::size_t tiles = reader.check();
  if (damages > 0) {
    throw InputError(
        fmt::format("{} part{} of the map cannot be read", damages, damages == 1 ? "" : "s"), path,
        kRestoreMap);
  }
  print_out("{}: whole, {} tiles\n", path, tiles);
  if (reader.format_version() != kMapFormatVersion) {
    print_out(
        "format {}: only the tiles have checksums; 'fovea repair' rewrites the map in "
        "format {}\n",
        reader.format_version(), kMapFormatVersion);
  }
}

/// A copy of the map alone would lack what is in its log.
void report_log(const std::string& map) {
  const std::filesystem::path log = log_of_map(map);
  if (log.empty()) return;
  print_out("note: {} is part of the map: copy and move both together\n", log.string());
}

void run(const InfoArguments& arguments) {
  if (is_city(arguments.map)) {
    return print_city(arguments.map, {arguments.json, arguments.digest, arguments.check});
  }
  fold_log(arguments.map);
  if (arguments.check) {
    check(arguments.map);
    return report_log(arguments.map);
  }
  const MapReader reader = open_map(arguments.map);
  if (arguments.digest) {
    print_out("{}\n", reader.digest());
  } else if (arguments.json) {
    print_json(read_contents(reader));
  } else {
    print_text(read_contents(reader), arguments.map);
    report_log(arguments.map);
  }
}

}  // namespace

void add_info_command(CLI::App& app, Session&) {
  auto arguments = std::make_shared<InfoArguments>();
  CLI::App* command = app.add_subcommand("info", "Describe a map or a city");
  command
      ->add_option("MAP.fovea", arguments->map,
                   "Map file, or a city: its folder or one of its manifests")
      ->required();
  CLI::Option* json = command->add_flag("--json", arguments->json, "As JSON");
  command
      ->add_flag("--digest", arguments->digest,
                 "Only a hash of everything but timings: equal for equal maps")
      ->excludes(json);
  command->add_flag("--check", arguments->check, "Read everything and name each damaged row");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
