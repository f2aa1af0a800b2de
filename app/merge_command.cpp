// fovea merge: two maps of one place as one.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/merging/merge_maps.h"

namespace fovea::app {
namespace {

struct MergeArguments {
  std::string a, b, output;
  std::size_t memory = MergeJob().memory;
  int threads = 0;
  bool force = false, quiet = false;
};

void print(const MergeFigures& figures, const std::string& output) {
  print_out("{}: {} points\n", output, figures.points);
  if (figures.drives_added == 0) {
    print_out("nothing new: the first map has what the second one shows\n");
    return;
  }
  const MapAlignment& alignment = figures.alignment;
  print_out("submaps registered: {} of {} that have the other map around them, moved by {:.2f} m\n",
            alignment.registered, alignment.met, alignment.moved);
  print_out("points added: {}, known already: {}, coloured by both: {}\n", figures.merged.added,
            figures.merged.known, figures.merged.fused);
  const auto factor = [&](int channel) { return std::exp2(-figures.gain_of_b[channel]); };
  print_out("brightness of the second map: x {:.2f} {:.2f} {:.2f}\n", factor(0), factor(1),
            factor(2));
}

/// Of the two maps and of their alignment.
std::vector<std::string> warnings_of(const MapReader& a, const MapReader& b,
                                     const MergeArguments& arguments, const MergeFigures& figures) {
  std::vector<std::string> warnings;
  for (const auto& [map, path] : {std::pair(&a, arguments.a), {&b, arguments.b}}) {
    for (const std::string& warning : warnings_of_map(map->meta())) {
      warnings.push_back(fmt::format("{}: {}", path, warning));
    }
  }
  if (figures.drives_added > 0 && figures.alignment.registered == 0) {
    warnings.push_back(fmt::format(
        "not registered: the maps lie to each other as {}",
        figures.georeferenced ? "their georeference says" : "if they had one local frame"));
  }
  return warnings;
}

void run(const MergeArguments& arguments, Warnings& warnings) {
  check_files(
      {{arguments.a, arguments.b}, {{arguments.output, ContentKind::kMap, arguments.force}}});
  const ThreadLimit threads(arguments.threads);
  const MapReader a = open_map(arguments.a), b = open_map(arguments.b);
  MergeJob job;
  job.output = arguments.output;
  job.force = arguments.force;
  job.memory = arguments.memory;
  job.spacing = stored_settings(a.meta(), arguments.a).spacing();
  const MergeFigures figures = merge_maps(a, b, job);
  if (!arguments.quiet) print(figures, arguments.output);
  warnings.add(warnings_of(a, b, arguments, figures), arguments.quiet);
}

}  // namespace

void add_merge_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command =
      app.add_subcommand("merge", "Put two maps of one place together, in the first one's frame");
  command->add_option("A.fovea", arguments->a, "Map file")->required();
  command->add_option("B.fovea", arguments->b, "Map file")->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("OUT.fovea");
  command->add_option("--memory", arguments->memory, "As of 'fovea map'")
      ->transform(memory_size())
      ->type_name("SIZE");
  command->add_option("--threads", arguments->threads, "Threads that may be used (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--force", arguments->force,
                    "Overwrite OUT, and merge also what does not overlap or has no georeference");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
