// fovea calibrate: estimates the calibration of a drive and writes a drive with it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/html_report/calibration_page.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "app/reports.h"
#include "fovea/core/output_file.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/calibrated_drive.h"
#include "fovea/drive/command_files.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/pipeline/calibration_json.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/drive_calibration.h"

namespace fovea::app {
namespace {

namespace fs = std::filesystem;

constexpr int kOverlays = 3;  // a camera
constexpr const char* kPageName = "calibration.html";

struct CalibrateArguments {
  DriveArguments drive;
  std::string output, poses, hold_out, json;
  int threads = 0;
  bool force = false, quiet = false;
};

std::string page_of(const CalibrateArguments& arguments) {
  return (fs::path(arguments.output) / kPageName).string();
}

CommandFiles files_of(const CalibrateArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.drive.drive, arguments.poses};
  files.outputs = {{arguments.json, ContentKind::kReport, arguments.force}};
  if (fs::exists(arguments.output)) {
    files.outputs.push_back({page_of(arguments), ContentKind::kHtml, arguments.force});
  }
  files.folder = {arguments.output, FolderUse::kAddTo};
  return files;
}

DriveCalibrationJob job_of(const CalibrateArguments& arguments, const DriveInfo& drive) {
  DriveCalibrationJob job;
  job.track.settings = load_preset("default");
  job.overlays = kOverlays;
  const HoldOut hold_out = parse_hold_out(arguments.hold_out);
  job.usable = [hold_out](int index) { return !hold_out.contains(index); };
  if (!arguments.poses.empty()) {
    job.track.given_poses = read_poses(arguments.poses, drive.begin, drive.end);
    const bool are_complete = job.track.given_poses.size() >= std::size_t(drive.end - drive.begin);
    job.track.pose_source = are_complete ? PoseSource::kGiven : PoseSource::kGivenFirst;
  }
  return job;
}

/// A bar for each pass over the scans.
DriveCalibration calibrate(const DriveInfo& drive, DriveCalibrationJob& job, bool quiet) {
  std::optional<ProgressBar> bar;
  job.track.progress = [&](int done, int total) {
    if (done == 1) bar.emplace(quiet);
    bar->draw(done, total, "registered");
  };
  return calibrate_drive(drive, job);
}

void write_text(const std::string& path, const std::string& text, bool force) {
  OutputFile file(path, force);
  file.stream() << text;
  file.commit();
}

void run(const CalibrateArguments& arguments, Session& session) {
  check_files(files_of(arguments));
  const ThreadLimit threads(arguments.threads);
  const std::unique_ptr<FrameSource> source = arguments.drive.open();
  const DriveInfo& drive = source->info();
  check_calibrated_drive(arguments.output, drive.path, arguments.force);
  if (!drive.imu) require_cameras(drive, "calibration");
  DriveCalibrationJob job = job_of(arguments, drive);
  session.warnings.add(drive, "note: ", arguments.quiet);
  const DriveCalibration found = calibrate(drive, job, arguments.quiet);
  const Messages messages = calibration_messages(found, /*applied=*/true);
  fs::create_directory(arguments.output);
  const CalibrationPage page{arguments.drive.drive, drive, found, messages.warnings,
                             arguments.output};
  write_text(page_of(arguments), calibration_page(page), arguments.force);
  if (!arguments.json.empty()) {
    const nlohmann::ordered_json json{{"calibration", to_json(found.cameras, /*applied=*/true)},
                                      {"imu_calibration", to_json(found.imu)}};
    write_text(arguments.json, json.dump(2) + "\n", arguments.force);
  }
  write_calibrated_drive(arguments.output, drive.path, correction_of(drive, found),
                         arguments.force);
  session.warnings.add(messages, "", arguments.quiet);
  if (arguments.quiet) return;
  print_out("{0}: a drive with the estimated calibration; {0}/{1} shows it\n", arguments.output,
            kPageName);
}

}  // namespace

void add_calibrate_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "Estimate the extrinsics and time offsets of a drive's cameras and IMU");
  command->add_option("DRIVE", arguments->drive.drive, "The drive (docs/drives.md)")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder to write: a drive.toml, which names DRIVE, and calibration.html")
      ->required()
      ->type_name("DIR");
  command->add_option("--frames", arguments->drive.frames, "Half-open range of frame indices")
      ->type_name("A:B");
  command
      ->add_option("--cameras", arguments->drive.cameras, "Cameras (default: as for map), or none")
      ->type_name("K,...");
  command
      ->add_option("--hold-out", arguments->hold_out,
                   "Frames whose images are not used, as for map")
      ->type_name("SPEC");
  command->add_option("--poses", arguments->poses, "A file of T_local_lidar, as for map")
      ->type_name("FILE");
  command->add_flag("--no-navigation", arguments->drive.no_navigation,
                    "Leave out GPS/INS or poses; of GPS/INS the rates count");
  command->add_flag("--no-imu", arguments->drive.no_imu, "Leave out the IMU");
  command->add_option("--json", arguments->json, "Write the values as JSON")->type_name("FILE");
  add_mask_option(*command, arguments->drive);
  command->add_option("--threads", arguments->threads, "Threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--force", arguments->force, "Overwrite DIR/drive.toml and FILE");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace fovea::app
