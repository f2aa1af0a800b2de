// fovea check: what a drive contains, without mapping it.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/drive_check_text.h"
#include "app/print.h"
#include "fovea/core/output_file.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

constexpr int kSamples = 20;  // frames that are read

struct CheckArguments {
  DriveArguments drive;
  std::string overlay;
  std::optional<int> frame, camera;
  bool force = false;
};

/// Place of a camera in the calibration.
std::size_t slot_of(const DriveInfo& drive, std::optional<int> number) {
  require_cameras(drive, "an overlay");
  if (!number) return 0;
  const std::vector<Camera>& cameras = drive.calibration.cameras;
  for (std::size_t slot = 0; slot < cameras.size(); ++slot) {
    if (cameras[slot].index == *number) return slot;
  }
  throw ConfigError("the drive has no such camera, or --cameras leaves it out",
                    "--camera " + std::to_string(*number),
                    "choose one of the cameras that 'fovea check' prints");
}

void run(const CheckArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.drive.drive};
  files.outputs = {{arguments.overlay, ContentKind::kPng, arguments.force}};
  check_files(files);
  const std::unique_ptr<FrameSource> source = arguments.drive.open();
  const DriveInfo& drive = source->info();
  for (const std::string& line : lines_of(check_drive(*source, kSamples), drive, /*messages=*/true))
    print_out("{}\n", line);
  if (arguments.overlay.empty()) return;
  const std::vector<int> frames = drive.frame_indices();
  const int frame = arguments.frame.value_or(frames[frames.size() / 2]);
  if (frame < drive.begin || frame >= drive.end) {
    throw ConfigError("the drive has no such frame", "--frame " + std::to_string(frame),
                      "choose another one");
  }
  const std::size_t slot = slot_of(drive, arguments.camera);
  OutputFile file(arguments.overlay, arguments.force);
  const std::vector<std::uint8_t> png = encode_png(calibration_overlay(*source, frame, slot));
  file.stream().write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
  file.commit();
  print_out("{}: edges of the scan on the image of camera {} in frame {}\n", arguments.overlay,
            drive.calibration.cameras[slot].index, frame);
}

}  // namespace

void add_check_command(CLI::App& app, Session& /*session*/) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check", "Show what a drive contains and how it would be mapped, without mapping it");
  command->add_option("DRIVE", arguments->drive.drive, "The drive (docs/drives.md)")->required();
  command->add_option("--frames", arguments->drive.frames, "A:B, half-open (default: all)");
  command->add_option("--cameras", arguments->drive.cameras,
                      "As for map (default: those that map takes)");
  command
      ->add_option("--overlay", arguments->overlay,
                   "Draw the edges of a scan on its image: a right calibration lays them on the "
                   "image's edges")
      ->type_name("OUT.png");
  command->add_option("--frame", arguments->frame, "Of the overlay (default: the middle one)");
  command->add_option("--camera", arguments->camera, "Of the overlay (default: the first one)");
  command->add_flag("--force", arguments->force, "Overwrite OUT.png");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
