// fovea reproduce: the paper's tables and figures on given drives.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "tools/paper/reproduce.h"
#include "tools/paper/rows.h"

namespace fovea::app {
namespace {

struct ReproduceArguments {
  std::vector<std::string> drives, rows;
  std::string output, cameras, frames, mls;
  int threads = 0;
  bool quiet = false;
};

/// Rows as asked for, in the order of the tables.
std::vector<std::string> wanted_rows(const ReproduceArguments& arguments) {
  if (arguments.rows.empty()) return paper::reproduced_rows();
  std::vector<std::string> rows;
  for (const std::string& row : paper::reproduced_rows()) {
    if (std::find(arguments.rows.begin(), arguments.rows.end(), row) != arguments.rows.end())
      rows.push_back(row);
  }
  return rows;
}

std::string command_line(const ReproduceArguments& arguments) {
  std::string text = "fovea reproduce";
  for (const std::string& drive : arguments.drives) {
    text += " " + std::filesystem::path(drive).lexically_normal().filename().string();
  }
  text += " -o " + std::filesystem::path(arguments.output).filename().string();
  if (!arguments.cameras.empty()) text += " --cameras " + arguments.cameras;
  if (!arguments.frames.empty()) text += " --frames " + arguments.frames;
  if (!arguments.mls.empty()) {
    text += " --mls " + std::filesystem::path(arguments.mls).filename().string();
  }
  return text;
}

CommandFiles files_of(const ReproduceArguments& arguments) {
  CommandFiles files;
  files.inputs = arguments.drives;
  files.inputs.push_back(arguments.mls);
  files.folder = {arguments.output, FolderUse::kAddTo};
  const std::filesystem::path folder = arguments.output;
  if (std::filesystem::is_directory(folder)) {
    files.outputs = {{folder / "results.json", ContentKind::kReport, /*force=*/true},
                     {folder / "results.md", ContentKind::kMarkdown, /*force=*/true}};
  }
  return files;
}

void run(const ReproduceArguments& arguments, Warnings& warnings) {
  check_files(files_of(arguments));
  const ThreadLimit threads(arguments.threads);
  paper::ReproduceJob job;
  job.rows = wanted_rows(arguments);
  job.output = arguments.output;
  job.command = command_line(arguments);
  for (const std::string& drive : arguments.drives) {
    job.drives.push_back(DriveArguments{drive, arguments.frames, arguments.cameras, {}}.open());
    require_cameras(job.drives.back()->info(), "the paper's method");
  }
  job.names = paper::drive_names(arguments.drives);
  if (!arguments.mls.empty()) job.mls = paper::read_mls_times(arguments.mls);
  ProgressBar bar(arguments.quiet, "rows");
  job.progress = [&](int done, int total, const std::string& row) {
    bar.draw(done, total, row + "  ");
  };
  warnings.add(paper::reproduce(job), arguments.quiet);
  if (!arguments.quiet) print_out("{}\n", (job.output / "results.md").string());
}

}  // namespace

void add_reproduce_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command =
      app.add_subcommand("reproduce", "The paper's tables and figures on drives of your own");
  command->add_option("DRIVE", arguments->drives, "Drives, one or more")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for results.md, results.json, charts and a report page")
      ->required()
      ->type_name("DIR");
  command->add_option("--cameras", arguments->cameras, "Cameras, in turn (default: 2)")
      ->type_name("K,...");
  command->add_option("--frames", arguments->frames, "Half-open range of frame indices")
      ->type_name("A:B");
  command->add_option("--rows", arguments->rows, "Only these rows (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(paper::reproduced_rows()));
  command
      ->add_option("--mls", arguments->mls,
                   "Times of PCL's moving least squares for Table I, from upsampling_bench --json")
      ->type_name("FILE");
  command->add_option("--threads", arguments->threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
