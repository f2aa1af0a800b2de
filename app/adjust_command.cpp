// fovea adjust: poses and gains of many maps in one frame.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/job_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/merging/adjustment.h"
#include "fovea/merging/georeference.h"
#include "fovea/merging/pair_file.h"
#include "fovea/merging/poses_file.h"

namespace fovea::app {
namespace {

struct AdjustArguments {
  std::vector<std::string> files;  // maps and pairs
  std::string output, control, fixed;
  CoordinateReference stated;
  int threads = 0;
  bool if_missing = false, force = false, quiet = false;
};

bool is_pair(const std::string& file) { return file.ends_with(".json"); }

AdjustmentJob job_of(const AdjustArguments& arguments) {
  AdjustmentJob job;
  for (const std::string& file : arguments.files) {
    if (is_pair(file)) {
      job.pairs.push_back(read_pair(file));
      continue;
    }
    const MapReader map = open_map(file);
    const auto held = map.hold_state();
    MapContent content(map);
    state_coordinates(arguments.stated, content);
    job.maps.push_back({name_of(map, content), content});
  }
  if (!arguments.control.empty()) job.points = read_surveyed_points(arguments.control);
  if (!arguments.fixed.empty()) {
    CityPoses fixed = read_city_poses(arguments.fixed);
    job.fixed = std::move(fixed.maps);
    job.origin = fixed.origin;
  }
  return job;
}

void print(const CityPoses& city, const std::string& output) {
  std::size_t submaps = 0;
  for (const PlacedMap& map : city.maps) submaps += map.submaps.size();
  print_out("{}: {} submaps of {} maps\n", output, submaps, city.maps.size());
  for (const PlacedMap& map : city.maps) {
    print_out("  {} {}: {} matches, moved by {:.2f} m{}\n", map.name.drive,
              map.name.identity.substr(0, 8), map.matches, map.moved,
              map.is_fixed ? ", fixed" : "");
  }
  for (const PointResidual& point : city.points) {
    const Eigen::Vector3d cm = 100 * point.east_north_up;
    print_out("  {} point {}: {:+.1f} {:+.1f} {:+.1f} cm (east, north, up)\n",
              point.is_check ? "check" : "control", point.name, cm.x(), cm.y(), cm.z());
  }
}

std::vector<std::string> warnings_of(const CityPoses& city) {
  std::vector<std::string> warnings;
  for (const RejectedMatch& match : city.rejected) {
    warnings.push_back(fmt::format(
        "a match is left out: submap {} of {} and submap {} of {} lie {:.2f} m elsewhere",
        match.submap_a, match.identity_a.substr(0, 8), match.submap_b,
        match.identity_b.substr(0, 8), match.distance));
  }
  for (const PlacedMap& map : city.maps) {
    if (map.matches > 0 || map.is_fixed || city.maps.size() == 1) continue;
    warnings.push_back(
        fmt::format("{} {} has no match with another map: navigation alone "
                    "places it",
                    map.name.drive, map.name.identity.substr(0, 8)));
  }
  return warnings;
}

void run(const AdjustArguments& arguments, Warnings& warnings) {
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  std::vector<std::string> inputs = arguments.files;
  for (const std::string& file : {arguments.control, arguments.fixed}) {
    if (!file.empty()) inputs.push_back(file);
  }
  check_files({inputs, {{arguments.output, ContentKind::kCityPoses, arguments.force}}});
  const ThreadLimit threads(arguments.threads);
  const CityPoses city = adjust_city(job_of(arguments));
  write_city_poses(city, arguments.output, arguments.force);
  if (!arguments.quiet) print(city, arguments.output);
  warnings.add(warnings_of(city), arguments.quiet);
}

}  // namespace

void add_adjust_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<AdjustArguments>();
  CLI::App* command =
      app.add_subcommand("adjust", "Find the poses and gains of many maps in one frame");
  command
      ->add_option("FILES", arguments->files, "Maps (.fovea), and pairs of them (.json) by 'align'")
      ->required();
  command->add_option("-o,--output", arguments->output, "File to write")
      ->required()
      ->type_name("POSES.json");
  command->add_option("--control", arguments->control, "Surveyed points (docs/city.md)")
      ->type_name("FILE.csv");
  command
      ->add_option("--fixed", arguments->fixed,
                   "Poses of an earlier run: the submaps in it stay where they are")
      ->type_name("POSES.json");
  command
      ->add_option("--datum", arguments->stated.datum,
                   "Datum of the drives that state none, such as ITRF2014")
      ->type_name("NAME");
  command->add_option("--epoch", arguments->stated.epoch_year, "Epoch of this datum: 2020.5")
      ->type_name("YEAR")
      ->check(finite_range(1900.0, 2200.0));
  command
      ->add_option("--heights", arguments->stated.heights,
                   "Heights of these drives: above the ellipsoid, or above the geoid (orthometric)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, HeightType>{
          {"ellipsoidal", HeightType::kEllipsoidal}, {"orthometric", HeightType::kOrthometric}}));
  command->add_option("--threads", arguments->threads, "Threads that may be used (default: all)")
      ->check(whole_number(0, kMaxThreads));
  add_if_missing_option(*command, arguments->if_missing);
  command->add_flag("--force", arguments->force, "Overwrite POSES.json");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
