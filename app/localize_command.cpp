// fovea localize: where a drive's scans were taken, in a map made before.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/localization_truth.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "app/reports.h"
#include "fovea/city/city.h"
#include "fovea/core/errors.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/localization/localize_drive.h"
#include "fovea/localization/pose_table.h"
#include "fovea/map/map_meta.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea::app {
namespace {

struct LocalizeArguments {
  DriveArguments drive;
  std::string map, output, guess, only, report;
  std::vector<std::string> truths;
  int threads = 0;
  bool force = false, quiet = false;
};

constexpr const char* kNavigation = "navigation";
constexpr const char* kFirst = "first";

/// The poses of a file as a guess: one is that of the first scan, more are those of the frames.
LocalizationGuess guess_of_file(const std::string& file, const FrameSource& drive) {
  LocalizationGuess guess;
  if (const auto all = read_poses_with_gaps(file); all.size() == 1 && all.front()) {
    guess.first = all.front();
    return guess;
  }
  const DriveInfo& info = drive.info();
  std::vector<StampedPose> stamped;
  int index = info.begin;
  for (const auto& T_local_lidar : read_poses_with_gaps(file, info.begin, info.end)) {
    const auto stamp = drive.stamp(index++);
    if (stamp && T_local_lidar) stamped.push_back({*stamp, *T_local_lidar});
  }
  if (stamped.empty()) {
    throw InputError("no frame has both a pose there and a time stamp", file,
                     "give poses of frames that have stamps");
  }
  guess.trajectory = Trajectory(std::move(stamped));
  return guess;
}

/// A map or a city.
struct Place {
  std::optional<City> city;
  std::optional<MapReader> map;
  std::optional<GeodeticPoint> origin;  ///< of its local frame

  std::unique_ptr<SurfaceSource> surfaces() const {
    return city ? city_surface_source(*city) : map_surface_source(*map);
  }
};

Place open_place(const std::string& path) {
  Place place;
  if (is_city(path)) {
    place.city = open_city(path);
    place.origin = place.city->origin;
  } else {
    place.map.emplace(open_map(path));
    place.origin = map_origin(place.map->meta());
  }
  return place;
}

LocalizationGuess find_guess(LocalizeArguments& arguments, const FrameSource& drive,
                             const std::optional<GeodeticPoint>& origin) {
  const bool choose = arguments.guess.empty();
  LocalizationGuess guess;
  if (choose || arguments.guess == kNavigation) {
    if (origin) guess.trajectory = navigation_in_local(drive.info(), *origin);
    if (!guess.trajectory && !choose) {
      throw InputError(
          "there is no navigation to guess by: it takes a drive with GPS/INS and a "
          "georeferenced map",
          arguments.drive.drive, "leave --guess out or give a file of poses");
    }
    arguments.guess = guess.trajectory ? kNavigation : kFirst;
    return guess;
  }
  return arguments.guess == kFirst ? guess : guess_of_file(arguments.guess, drive);
}

nlohmann::ordered_json to_json(const LocalizedDrive& localized, const std::string& guess) {
  nlohmann::ordered_json latency = nlohmann::ordered_json::object();
  for (const auto& [stage, times] : localized.latency_ms) {
    latency[stage] = fovea::to_json(times);
  }
  double health = 0;
  for (const Localization& frame : localized.frames) {
    if (frame.state == LocalizationState::kLocalized) health += frame.health;
  }
  const int localized_frames = localized.count(LocalizationState::kLocalized);
  return {{"guess", guess},
          {"frames", localized.frames.size()},
          {"localized", localized_frames},
          {"lost", localized.count(LocalizationState::kLost)},
          {"outside", localized.count(LocalizationState::kOutside)},
          {"skipped", localized.count(LocalizationState::kSkipped)},
          {"found", localized.found()},
          {"health_mean", localized_frames > 0 ? health / localized_frames : 0},
          {"fps", localized.frames_per_second},
          {"peak_rss_mb", localized.peak_rss_mb},
          {"latency_ms", latency}};
}

void print_summary(const LocalizeArguments& arguments, const LocalizedDrive& localized) {
  print_out("{}: {} of {} frames localized (guess: {}), {:.1f} frames/s, {:.0f} MB peak\n",
            arguments.output, localized.count(LocalizationState::kLocalized),
            localized.frames.size(), arguments.guess, localized.frames_per_second,
            localized.peak_rss_mb);
}

/// What the drive and the run say, with a warning of frames without a pose.
Messages messages_of(const FrameSource& drive, const LocalizedDrive& localized) {
  Messages messages = drive.info();
  messages.append(localized);
  for (const auto& [state, meaning] :
       {std::pair(LocalizationState::kLost, "lost: the scan fits nowhere that was tried"),
        {LocalizationState::kOutside, "outside: the map has nothing there"}}) {
    const int count = localized.count(state);
    if (count > 0) {
      messages.warn(fmt::format("{} frame{} {}", count, count == 1 ? "" : "s", meaning));
    }
  }
  return messages;
}

/// A pose file without any pose is none.
void require_poses(const LocalizedDrive& localized, const LocalizeArguments& arguments) {
  if (localized.count(LocalizationState::kLocalized) > 0) return;
  const bool outside =
      localized.count(LocalizationState::kOutside) > localized.count(LocalizationState::kLost);
  throw InputError(
      fmt::format("no scan could be localized: {}",
                  outside ? "the drive lies outside the map" : "the scans fit nowhere in the map"),
      fmt::format("{} in {}", arguments.drive.drive, arguments.map),
      "give a map of the place, or a better --guess");
}

bool writes_table(const LocalizeArguments& arguments) {
  return std::filesystem::path(arguments.output).extension() == ".csv";
}

CommandFiles files_of(const LocalizeArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.drive.drive, arguments.map};
  files.inputs.insert(files.inputs.end(), arguments.truths.begin(), arguments.truths.end());
  if (arguments.guess != kNavigation && arguments.guess != kFirst) {
    files.inputs.push_back(arguments.guess);
  }
  const ContentKind kind = writes_table(arguments) ? ContentKind::kPoseTable : ContentKind::kPoses;
  files.outputs = {{arguments.output, kind, arguments.force},
                   {arguments.report, ContentKind::kReport, /*force=*/true}};
  return files;
}

std::optional<LocalizationTruth> open_truths(const LocalizeArguments& arguments,
                                             const FrameSource& drive, const Place& place) {
  const std::vector<std::string>& truths = arguments.truths;
  if (truths.empty()) return std::nullopt;
  if (place.city) return open_city_truth(truths, drive, *place.city, arguments.quiet);
  if (truths.size() > 1) {
    throw ConfigError("several drives are for a city", "--truth", "give the drive of the map");
  }
  return open_truth(truths.front(), drive, *place.map, arguments.map, arguments.quiet);
}

void run(LocalizeArguments arguments, Warnings& warnings) {
  check_files(files_of(arguments));
  const ThreadLimit threads(arguments.threads);
  OutputFile output(arguments.output, arguments.force);  // first: a bad path must not cost a run
  std::optional<OutputFile> report;
  if (!arguments.report.empty()) report.emplace(arguments.report, /*force=*/true);
  const Place place = open_place(arguments.map);
  DriveOptions wanted = arguments.drive.options();
  wanted.use_images = false;
  const auto drive = open_drive(arguments.drive.drive, wanted);
  LocalizationJob job;
  job.guess = find_guess(arguments, *drive, place.origin);
  job.only = parse_frame_set(arguments.only, "--only");
  const std::optional<LocalizationTruth> truth = open_truths(arguments, *drive, place);
  const LocalizedDrive localized = [&] {
    ProgressBar bar(arguments.quiet);
    return localize_drive(*drive, place.surfaces(), job,
                          [&](int done, int total) { bar.draw(done, total); });
  }();
  require_poses(localized, arguments);
  if (writes_table(arguments)) {
    write_pose_table(localized.frames, output.stream());
  } else {
    write_pose_lines(localized.frames, drive->info().begin, drive->info().end, output.stream());
  }
  nlohmann::ordered_json figures = to_json(localized, arguments.guess);
  const Messages messages = messages_of(*drive, localized);
  figures["warnings"] = messages.warnings;
  warnings.add(messages, "note: ", arguments.quiet);
  if (!arguments.quiet) print_summary(arguments, localized);
  if (truth) {
    const LocalizationErrors errors = localization_errors(*truth, localized);
    figures["truth"] = to_json(errors);
    if (!arguments.quiet) print_errors(errors);
  }
  output.commit();
  if (report) write_json(*report, {{"localize", figures}});
}

}  // namespace

void add_localize_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<LocalizeArguments>();
  CLI::App* command =
      app.add_subcommand("localize", "Find where a drive's scans were taken in a map or a city");
  command->add_option("DRIVE", arguments->drive.drive, "Drive folder; its images are not needed")
      ->required();
  command->add_option("MAP", arguments->map, "Map file, or the folder or manifest of a city")
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Poses to write: KITTI's lines, or a table with covariances (.csv)")
      ->required()
      ->type_name("POSES.txt|.csv");
  command->add_option("--guess", arguments->guess,
                      "navigation, first (no guess: the map's first places are tried first), or a "
                      "file with the first scan's pose or all frames' (default: navigation where "
                      "there is one)");
  command->add_option("--frames", arguments->drive.frames, "Half-open range A:B");
  command->add_option("--only", arguments->only, "Only these frames, as --hold-out of map");
  command
      ->add_option(
          "--truth", arguments->truths,
          "Of simulated drives: the drive that the map was made of, to report errors; of a "
          "city one of its drives, may be repeated")
      ->type_name("MAP_DRIVE")
      ->allow_extra_args(false);
  command->add_option("--report", arguments->report, "Write figures as JSON")->type_name("FILE");
  command->add_option("--threads", arguments->threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--force", arguments->force, "Overwrite the output");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
