// fovea align: how two overlapping maps lie to each other.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/job_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/merging/pair_file.h"

namespace fovea::app {
namespace {

struct AlignArguments {
  std::string a, b, output;
  int threads = 0;
  bool if_missing = false, force = false, quiet = false;
};

void print(const MapPair& pair, const std::string& output) {
  print_out("{}: {} of {} pairs of submaps match, moved by {:.2f} m\n", output, pair.matches.size(),
            pair.tried, pair.moved);
}

std::string warning_of(const MapPair& pair) {
  if (pair.verdict == PairVerdict::kNoOverlap) {
    return fmt::format("{} and {} do not overlap: the file has no matches", pair.a.drive,
                       pair.b.drive);
  }
  return fmt::format(
      "{} and {} overlap, but too few of their surfaces fit: the file has no matches", pair.a.drive,
      pair.b.drive);
}

void run(const AlignArguments& arguments, Warnings& warnings) {
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  check_files(
      {{arguments.a, arguments.b}, {{arguments.output, ContentKind::kMapPair, arguments.force}}});
  const ThreadLimit threads(arguments.threads);
  const MapReader a = open_map(arguments.a), b = open_map(arguments.b);
  const MapPair pair = align_pair(a, b);
  write_pair(pair, arguments.output, arguments.force);
  if (!arguments.quiet) print(pair, arguments.output);
  if (pair.verdict != PairVerdict::kFits) warnings.add({warning_of(pair)}, arguments.quiet);
}

}  // namespace

void add_align_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<AlignArguments>();
  CLI::App* command = app.add_subcommand(
      "align", "Find how two overlapping maps lie to each other, submap by submap");
  command->add_option("A.fovea", arguments->a, "Map file")->required();
  command->add_option("B.fovea", arguments->b, "Map file")->required();
  command->add_option("-o,--output", arguments->output, "File to write, for 'fovea adjust'")
      ->required()
      ->type_name("PAIR.json");
  command->add_option("--threads", arguments->threads, "Threads that may be used (default: all)")
      ->check(whole_number(0, kMaxThreads));
  add_if_missing_option(*command, arguments->if_missing);
  command->add_flag("--force", arguments->force, "Overwrite PAIR.json");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
