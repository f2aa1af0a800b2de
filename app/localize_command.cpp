// fovea localize: where a drive's scans were taken, in a map made before.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/localization_truth.h"
#include "app/localize_job.h"
#include "app/localize_live_command.h"
#include "app/number_checks.h"
#include "app/progress_bar.h"
#include "app/reports.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/bridge/bridge_address.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/localization/localize_drive.h"

namespace fovea::app {
namespace {

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

LocalizationGuess find_guess(LocalizeArguments& arguments, const FrameSource& drive,
                             const std::optional<GeodeticPoint>& origin) {
  const bool choose = arguments.guess.empty();
  LocalizationGuess guess;
  if (choose || arguments.guess == kNavigationGuess) {
    if (origin) guess.trajectory = navigation_in_local(drive.info(), *origin);
    if (!guess.trajectory && !choose) {
      throw InputError(
          "there is no navigation to guess by: it takes a drive with GPS/INS and a "
          "georeferenced map",
          arguments.drive.drive, "leave --guess out or give a file of poses");
    }
    arguments.guess = guess.trajectory ? kNavigationGuess : kFirstGuess;
    return guess;
  }
  return arguments.guess == kFirstGuess ? guess : guess_of_file(arguments.guess, drive);
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
  write_poses(localized, drive->info().begin, drive->info().end, arguments, output);
  nlohmann::ordered_json figures = to_json(localized, arguments.guess);
  Messages messages = drive->info();
  messages.append(localized);
  messages.append(missing_poses(localized));
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
  command
      ->add_option("DRIVE", arguments->drive.drive,
                   "Drive folder, whose images are not needed, or the Foxglove bridge of a "
                   "running robot (ws://HOST:8765)")
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
  auto live = std::make_shared<LiveArguments>();
  add_live_arguments(*command, *live);
  command->callback([arguments, live, command, &session] {
    const bool is_live = bridge::is_address(arguments->drive.drive);
    check_kind_of_options(*command, is_live);
    if (is_live) return localize_robot(*arguments, *live, session);
    run(*arguments, session.warnings);
  });
}

}  // namespace fovea::app
