// fovea evaluate: scores of a map against a drive.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/html_report/report_page.h"
#include "app/html_report/truth_page.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/city/city.h"
#include "fovea/core/output_file.h"
#include "fovea/core/parallel.h"
#include "fovea/core/path_name.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/evaluation/compare_color_rules.h"
#include "fovea/evaluation/drive_in_city.h"
#include "fovea/evaluation/evaluate.h"
#include "fovea/evaluation/evaluate_truth.h"
#include "fovea/evaluation/evaluate_uncolored.h"
#include "fovea/evaluation/scored_city.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_files/cloud_format.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea::app {
namespace {

struct EvaluateArguments {
  std::string map, protocol = "held-out", poses, hold_out, json, html, calibration;
  DriveArguments drive;
  int first_frame = 0, threads = 0;
  bool truth = false, no_align = false, color_rules = false, foreign = false;
};

constexpr const char* kTruth = "truth";
constexpr const char* kDrive = "drive";  // whose calibration, where it is no map's

/// What of the arguments does not go together; CLI::ValidationError.
void check(const EvaluateArguments& arguments) {
  if (arguments.truth && !arguments.hold_out.empty()) {
    throw CLI::ValidationError("--hold-out", "the truth scores the whole map");
  }
  if (arguments.no_align && !arguments.truth) {
    throw CLI::ValidationError("--no-align", "only the protocol truth aligns a map");
  }
  if (arguments.color_rules && arguments.protocol != "held-out") {
    throw CLI::ValidationError("--color-rules", "only the protocol held-out compares them");
  }
}

template <class Report>
void put_report(const Report& report, std::optional<OutputFile>& json, Warnings& warnings) {
  if (json) {
    json->stream() << to_json(report);
    json->commit();
  }
  print_lines(to_text(report));
  warnings.add(report.warnings);
}

struct ScoredDrive {
  ScoredMap map;
  std::unique_ptr<FrameSource> drive;
};

/// The cameras to score and to open the drive with: those of the map if none are named.
void choose_cameras(EvaluateArguments& arguments, const ScoredMap& map, ProtocolOptions& options) {
  if (!has_colors(map) && !arguments.html.empty()) {
    throw InputError("the map has no colors, of which the page makes pictures", arguments.map,
                     "evaluate it without --html");
  }
  std::string& cameras = arguments.drive.cameras;
  if (cameras.empty() && !has_colors(map)) cameras = kNoCameras;
  if (cameras == kNoCameras) {
    if (has_colors(map)) {
      throw ConfigError("scores of a map with colors need a camera", "--cameras",
                        "name the cameras to score, or leave it out");
    }
  } else if (!cameras.empty()) {
    options.cameras = parse_cameras(cameras);
  } else {
    cameras = fmt::format("{}", fmt::join(map.cameras, ","));
  }
}

/// Of a map or a cloud.
ScoredDrive load_map(EvaluateArguments& arguments, ProtocolOptions& options) {
  ScoredMapOptions loading;
  if (!arguments.poses.empty()) loading.poses = arguments.poses;
  loading.first_frame = arguments.first_frame;
  std::optional<MapReader> reader;  // of a map; a cloud has none
  if (!cloud_format(arguments.map)) reader.emplace(open_map(arguments.map));
  ScoredDrive scored;
  scored.map =
      reader && !loading.poses ? load_scored_map(*reader) : load_scored_map(arguments.map, loading);
  choose_cameras(arguments, scored.map, options);
  scored.drive = arguments.drive.open();
  if (reader) {
    const auto match = find_drive_in_map(*reader, arguments.map, *scored.drive, arguments.foreign);
    if (match && !match->keeps_numbers) choose_frames(match->number_in_drive, scored.map);
  }
  return scored;
}

/// The part of a city around the drive.
ScoredDrive load_city(EvaluateArguments& arguments, ProtocolOptions& options) {
  if (!arguments.poses.empty()) {
    throw ConfigError("a city has poses of its own", arguments.map, "leave out --poses");
  }
  if (options.protocol == Protocol::kInSampleNavigation) {
    throw ConfigError("a city has no navigation poses", "protocol in-sample-nav",
                      "use the protocol in-sample");
  }
  const City city = open_city(arguments.map);
  ScoredDrive scored;
  scored.drive = arguments.drive.open();
  const DriveInCity found = find_drive_in_city(city, *scored.drive, arguments.foreign);
  for (const std::string& note : found.notes) print_out("note: {}\n", note);
  scored.map = load_scored_city(city, found);
  choose_cameras(arguments, scored.map, options);
  scored.drive = arguments.drive.open();  // with the cameras that are scored
  return scored;
}

/// Whose calibration to score under: the drive's or a map's.
std::string calibration_of(const EvaluateArguments& arguments, const ScoredMap& map) {
  if (!arguments.calibration.empty()) return arguments.calibration;
  return has_stored_calibration(map.meta) ? arguments.map : kDrive;
}

/// A copy if the map is used again, else the map itself: its points take memory.
ScoredMap take(ScoredMap& map, bool is_used_again) {
  return is_used_again ? map : std::exchange(map, {});
}

void run(EvaluateArguments arguments, Warnings& warnings) {
  arguments.truth = arguments.truth || arguments.protocol == kTruth;
  if (arguments.truth) arguments.protocol = kTruth;
  check(arguments);
  CommandFiles files;
  files.inputs = {arguments.map, arguments.drive.drive, arguments.poses};
  if (arguments.calibration != kDrive) files.inputs.push_back(arguments.calibration);
  files.outputs = {{arguments.json, ContentKind::kReport, /*force=*/true},
                   {arguments.html, ContentKind::kHtml, /*force=*/true}};
  check_files(files);
  const ThreadLimit threads(arguments.threads);
  ProtocolOptions options;
  if (!arguments.truth) options.protocol = parse_protocol(arguments.protocol);
  options.hold_out = parse_hold_out(arguments.hold_out);
  std::optional<OutputFile> json;  // opened first: a bad path must not cost a run
  if (!arguments.json.empty()) json.emplace(arguments.json, /*force=*/true);
  std::optional<OutputFile> html;
  if (!arguments.html.empty()) html.emplace(arguments.html, /*force=*/true);

  auto [map, drive] =
      is_city(arguments.map) ? load_city(arguments, options) : load_map(arguments, options);
  const std::string calibration = calibration_of(arguments, map);
  if (calibration != kDrive) {
    const MapMeta meta = calibration == arguments.map ? map.meta : open_map(calibration).meta();
    drive = with_stored_calibration(std::move(drive), meta, calibration);
  }
  if (arguments.truth) {
    TruthEvaluation evaluation =
        evaluate_truth_points(take(map, html.has_value()), *drive, {.align = !arguments.no_align});
    evaluation.report.warnings = drive->info().warnings;
    put_report(evaluation.report, json, warnings);
    if (html) {
      html->stream() << truth_page(
          {map, *drive, evaluation, name_of(arguments.map), name_of(drive->info().path)});
      html->commit();
    }
  } else {
    EvaluationReport report = evaluate(take(map, html || arguments.color_rules), *drive, options);
    report.calibration = calibration;
    if (arguments.color_rules) report.color_rules = compare_color_rules(map, *drive, options);
    const std::vector<std::string>& of_drive = drive->info().warnings;
    report.warnings.insert(report.warnings.end(), of_drive.begin(), of_drive.end());
    put_report(report, json, warnings);
    if (html) {
      html->stream() << report_page(
          {map, *drive, options, report, name_of(arguments.map), name_of(drive->info().path)});
      html->commit();
    }
  }
}

}  // namespace

void add_evaluate_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "Score a map or a city against a drive");
  command
      ->add_option("MAP", arguments->map,
                   "Fovea map, city (folder or manifest), or colored cloud (PLY, PCD, LAS) with "
                   "--poses")
      ->required();
  command->add_option("DRIVE", arguments->drive.drive, "The drive whose scans and images score it")
      ->required();
  CLI::Option* protocol =
      command
          ->add_option("--protocol", arguments->protocol,
                       "held-out (quality), cross-camera (the same in a camera that coloured "
                       "nothing), in-sample (the paper's way), in-sample-nav, or truth "
                       "(simulated drives)")
          ->capture_default_str()
          ->check(
              CLI::IsMember({"in-sample", "in-sample-nav", "held-out", "cross-camera", kTruth}));
  command->add_flag("--truth", arguments->truth, "The same as --protocol truth")
      ->excludes(protocol);
  command->add_flag("--no-align", arguments->no_align,
                    "With truth: leave the map where its georeference says it lies");
  command->add_option("--poses", arguments->poses, "Poses of a cloud: one T_local_lidar a line")
      ->type_name("FILE");
  command
      ->add_option("--first-frame", arguments->first_frame,
                   "Frame index of the first line of --poses")
      ->capture_default_str()
      ->check(whole_number(0));
  command->add_option("--cameras", arguments->drive.cameras, "Scored cameras (default: the map's)")
      ->type_name("K,...");
  add_mask_option(*command, arguments->drive);
  command
      ->add_option("--hold-out", arguments->hold_out,
                   "Frames to score (default: those the map held out)")
      ->type_name("SPEC");
  command->add_flag("--color-rules", arguments->color_rules,
                    "Also compare colour rules on the map's points, by the training frames");
  command
      ->add_option("--calibration", arguments->calibration,
                   "Score under the calibration of the drive, or under the corrected one of a map "
                   "(default: MAP's, if it was made with --calibrate)")
      ->type_name("drive|FILE.fovea");
  add_foreign_option(*command, arguments->foreign);
  command->add_option("--json", arguments->json, "Write all figures as JSON")->type_name("FILE");
  command
      ->add_option("--html", arguments->html,
                   "Write a page with pictures and charts, one file that needs no network")
      ->type_name("FILE");
  command->add_option("--threads", arguments->threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
