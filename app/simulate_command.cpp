// fovea simulate: a drive with its truth, in KITTI's raw format or as a folder with a drive.toml.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/simulation/simulate.h"
#include "fovea/simulation/simulation_config.h"

namespace fovea::app {
namespace {

struct SimulateArguments {
  std::string output, scene = "street", noise = "default", format = "kitti", config;
  std::vector<std::string> settings;
  int seed = 1, frames = 100, threads = 0;
  bool quiet = false;
};

SimulationOptions resolve_options(const SimulateArguments& arguments) {
  SimulationOptions options = simulation_options(parse_scene(arguments.scene), arguments.noise);
  options.seed = arguments.seed;
  options.frames = arguments.frames;
  options.format = arguments.format == "generic" ? DriveFormat::kGeneric : DriveFormat::kKitti;
  if (!arguments.config.empty()) apply_config_file(arguments.config, options);
  for (const std::string& setting : arguments.settings) apply_setting(setting, options);
  return options;
}

void run(const SimulateArguments& arguments) {
  check_files({{arguments.config}, {}, {arguments.output}});
  const ThreadLimit threads(arguments.threads);
  const SimulationOptions options = resolve_options(arguments);
  const std::filesystem::path drive = [&] {
    ProgressBar bar(arguments.quiet);
    return simulate(options, arguments.output, [&](int done, int total) {
      bar.draw(done, total);
      return true;
    });
  }();
  if (!arguments.quiet) {
    print_out("{}: {} frame{} of scene {}, seed {}\n", drive.string(), options.frames,
              options.frames == 1 ? "" : "s", to_string(options.scene), options.seed);
  }
}

}  // namespace

void add_simulate_command(CLI::App& app, Session&) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command =
      app.add_subcommand("simulate", "Write a simulated drive together with what is true about it");
  command->add_option("-o,--output", arguments->output, "Folder to make")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--scene", arguments->scene,
                   fmt::format("One of {}", fmt::join(scene_names(), ", ")))
      ->capture_default_str()
      ->check(CLI::IsMember(scene_names()));
  command->add_option("--seed", arguments->seed, "Another seed, another drive")
      ->capture_default_str()
      ->check(whole_number(0));
  command->add_option("--frames", arguments->frames, "How many sweeps")
      ->capture_default_str()
      ->check(whole_number(1, SimulationOptions::kMaxFrames));
  command
      ->add_option("--noise", arguments->noise,
                   fmt::format("Of all sensors: {}", fmt::join(noise_names(), ", ")))
      ->capture_default_str()
      ->check(CLI::IsMember(noise_names()));
  command
      ->add_option("--format", arguments->format,
                   "kitti: KITTI raw; generic: a folder with a drive.toml (docs/drives.md)")
      ->capture_default_str()
      ->check(CLI::IsMember({"kitti", "generic"}));
  command->add_option("--config", arguments->config, "Keys that differ (docs/simulator.md)")
      ->type_name("FILE.toml");
  command->add_option("--set", arguments->settings, "One key, may be repeated")
      ->type_name("key=value")
      ->allow_extra_args(false);
  command->add_option("--threads", arguments->threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
