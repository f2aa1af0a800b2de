// fovea evaluate: scores of a map against a drive.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "fovea/base/output_file.h"
#include "fovea/base/parallel.h"
#include "fovea/evaluation/evaluate.h"

namespace fovea::app {
namespace {

struct EvaluateArguments {
  std::string map, protocol = "held-out", poses, hold_out, json;
  DriveArguments drive;
  int first_frame = 0, threads = 0;
};

void run(EvaluateArguments arguments) {
  const ThreadLimit threads(arguments.threads);
  ProtocolOptions options;
  options.protocol = parse_protocol(arguments.protocol);
  options.hold_out = parse_hold_out(arguments.hold_out);
  std::optional<OutputFile> json;  // opened first: a bad path must not cost a run
  if (!arguments.json.empty()) json.emplace(arguments.json, /*force=*/true);

  ScoredMapOptions loading;
  if (!arguments.poses.empty()) loading.poses = arguments.poses;
  loading.first_frame = arguments.first_frame;
  const ScoredMap map = load_scored_map(arguments.map, loading);
  if (!arguments.drive.cameras.empty()) {
    options.cameras = parse_cameras(arguments.drive.cameras);
  } else {
    arguments.drive.cameras = fmt::format("{}", fmt::join(map.cameras, ","));
  }
  const auto drive = arguments.drive.open();
  const EvaluationReport report = evaluate(map, *drive, options);
  if (json) {
    json->stream() << to_json(report);
    json->commit();
  }
  fmt::print("{}", to_text(report));
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "Score a map against a drive");
  command->add_option("MAP", arguments->map, "Fovea map, or coloured PLY cloud with --poses")
      ->required();
  command->add_option("DRIVE", arguments->drive.drive, "The drive whose scans and images score it")
      ->required();
  command
      ->add_option("--protocol", arguments->protocol,
                   "held-out (quality), in-sample (the paper's way) or in-sample-nav")
      ->capture_default_str()
      ->check(CLI::IsMember({"in-sample", "in-sample-nav", "held-out"}));
  command->add_option("--poses", arguments->poses, "Poses of a cloud: one T_local_lidar a line")
      ->type_name("FILE");
  command
      ->add_option("--first-frame", arguments->first_frame,
                   "Frame index of the first line of --poses")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--cameras", arguments->drive.cameras, "Scored cameras (default: the map's)")
      ->type_name("K,...");
  command
      ->add_option("--hold-out", arguments->hold_out,
                   "Frames to score (default: those the map held out)")
      ->type_name("SPEC");
  command->add_option("--json", arguments->json, "Write all figures as JSON")->type_name("FILE");
  command->add_option("--threads", arguments->threads, "At most this many threads (default: all)")
      ->check(CLI::NonNegativeNumber);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
