// fovea map: a drive in, a map out.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/drive_check_text.h"
#include "app/job_arguments.h"
#include "app/live_view.h"
#include "app/map_job.h"
#include "app/map_live_command.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "app/reports.h"
#include "fovea/core/parallel.h"
#include "fovea/core/process_memory.h"
#include "fovea/drive/bridge/bridge_address.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea::app {
namespace {

/// What a drive played live begins with, bytes, but no more than this part of what it is to keep
/// to.
constexpr std::size_t kWarmMemory = std::size_t{512} << 20, kWarmShare = 2;

/// Prints the contents of the drive if something about it is odd, without the notes that the run
/// prints. A drive that cannot be read is left to the run, whose error says more.
void print_if_odd(const FrameSource& source, const MapArguments& arguments) {
  constexpr int kSamples = 5;  // frames that are read
  if (arguments.quiet || arguments.resume || arguments.rate > 0) return;
  try {
    const DriveCheck check = check_drive(source, kSamples);
    if (check.oddities.empty()) return;
    for (const std::string& line : lines_of(check, source.info(), /*messages=*/false))
      print_out("{}\n", line);
  } catch (const InputError&) {
    return;
  }
}

void run(const MapArguments& arguments, Session& session) {
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  const bool has_file = arguments.poses != kRefinedPoses && arguments.poses != kNavigationPoses;
  CommandFiles files = files_of(arguments);
  files.inputs.push_back(arguments.drive.drive);
  if (has_file) files.inputs.push_back(arguments.poses);
  check_files(files);
  const ThreadLimit threads(arguments.threads);
  MapJob job = job_of(arguments);
  std::optional<OutputFile> report;  // opened first: a bad path must not cost a run
  if (!arguments.report.empty()) report.emplace(arguments.report, /*force=*/true);
  const std::shared_ptr<const FrameSource> source = arguments.drive.open();
  if (arguments.poses == kNavigationPoses) {
    job.pose_source = PoseSource::kNavigation;
  } else if (has_file) {
    job.pose_source = PoseSource::kGiven;
    const DriveInfo& info = source->info();
    job.given_poses = read_poses(arguments.poses, info.begin, info.end);
    if (job.given_poses.size() < std::size_t(info.end - info.begin)) {
      job.pose_source = PoseSource::kGivenFirst;
    }
  }
  print_if_odd(*source, arguments);
  // Played live, the first frames are as much in a hurry as any.
  if (job.rate > 0) warm_memory(std::min(kWarmMemory, job.memory / kWarmShare));
  // In a scratch folder nothing is kept of a run that does not end.
  if (job.scratch.empty()) job.stop = session.interrupt.stop_gently();
  LiveView view(arguments.live, job, source, arguments.quiet);
  const MapSummary summary = naming_log(arguments.output, [&] {
    ProgressBar bar(arguments.quiet);
    return map_drive(*source, job, std::ref(bar));
  });
  const Messages calibration = calibration_messages(summary.calibration, summary.calibrated);
  if (report) {
    MapSummary reported = summary;
    reported.append(calibration);
    write_json(*report, {{"map", to_json(reported)}});
  }
  print_run(summary, calibration, arguments, session);
  if (job.stop.stop_requested()) print_interruption(summary, arguments);
  view.keep_serving();
}

}  // namespace

void add_map_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = app.add_subcommand("map", "Build a textured map from a drive");
  command
      ->add_option("DRIVE", arguments->drive.drive,
                   "KITTI raw drive, odometry sequence, folder with a drive.toml, or the Foxglove "
                   "bridge of a running robot (ws://HOST:8765)")
      ->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("MAP.fovea");
  command
      ->add_option("--preset", arguments->preset,
                   fmt::format("One of {}", fmt::join(preset_names(), ", ")))
      ->capture_default_str()
      ->check(CLI::IsMember(preset_names()));
  command->add_option("--config", arguments->config, "Keys that differ from the preset")
      ->type_name("FILE.toml");
  command->add_option("--set", arguments->settings, "One key, may be repeated")
      ->type_name("key=value")
      ->allow_extra_args(false);
  command->add_option("--frames", arguments->drive.frames, "Half-open range of frame indices")
      ->type_name("A:B");
  command
      ->add_option("--cameras", arguments->drive.cameras,
                   "Cameras, in turn (default: 2), or none: the scans alone")
      ->type_name("K,...");
  add_mask_option(*command, arguments->drive);
  command
      ->add_option("--hold-out", arguments->hold_out,
                   "Frames that only get a pose: N:R (index % N == R) or blocks A-B,C-D")
      ->type_name("SPEC");
  command
      ->add_option("--poses", arguments->poses,
                   "refine, navigation, or a file of T_local_lidar; of a running robot refine, "
                   "navigation, or what refines: gnss, odometry, tf or none")
      ->capture_default_str();
  command
      ->add_option("--variant", arguments->variant,
                   "Row of the paper's table: E0..E11, baseline-gicp, -icp or -plane")
      ->check(CLI::IsMember(variant_names()));
  command
      ->add_option("--threads", arguments->threads,
                   "Threads that a stage may use (default: all); with 1, one stage at a time")
      ->check(whole_number(0, kMaxThreads));
  command
      ->add_option("--rate", arguments->rate,
                   "Play the drive as a live sensor would, and count late frames; none is dropped")
      ->type_name("HZ")
      ->check(finite_range(1e-3, 1e6));
  command
      ->add_option("--memory", arguments->memory,
                   "Memory to keep to (default: 1GiB): the map's parts out of reach are in the "
                   "file alone")
      ->type_name("SIZE")
      ->transform(memory_size());
  command->add_flag("--no-navigation", arguments->drive.no_navigation,
                    "Leave out GPS/INS or poses; of GPS/INS the rates and accelerations count");
  command->add_flag("--no-imu", arguments->drive.no_imu, "Leave out the IMU and wheel speeds");
  command->add_flag("--calibrate", arguments->calibrate,
                    "First estimate extrinsics and time offsets of cameras and IMU, and map with "
                    "the result");
  command->add_flag("--allow-dropped", arguments->allow_dropped,
                    "Map even if over 10 % of the scans' points cannot be used");
  command->add_flag("--resume", arguments->resume, "Go on with an unfinished map");
  add_if_missing_option(*command, arguments->if_missing)->excludes("--resume");
  add_scratch_option(*command, arguments->scratch)->excludes("--resume");
  command->add_flag("--force", arguments->force, "Overwrite the map");
  command->add_option("--report", arguments->report, "Write figures as JSON")
      ->type_name("FILE.json");
  add_live_option(*command, arguments->live);
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  auto live = std::make_shared<LiveArguments>();
  add_live_arguments(*command, *live);
  command->callback([arguments, live, command, &session] {
    const bool is_live = bridge::is_address(arguments->drive.drive);
    check_kind_of_options(*command, is_live);
    if (is_live) return map_robot(*arguments, *live, session);
    run(*arguments, session);
  });
}

}  // namespace fovea::app
