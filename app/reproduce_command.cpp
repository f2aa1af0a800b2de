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
#include "app/reports.h"
#include "app/reproduce/results_page.h"
#include "app/reproduce/rows.h"
#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/base/path_name.h"
#include "fovea/pipeline/command_files.h"

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
  if (arguments.rows.empty()) return reproduced_rows();
  std::vector<std::string> rows;
  for (const std::string& row : reproduced_rows()) {
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

/// What the user calls the drives: simulated ones all have the same folder inside. A name that
/// comes again gets a number.
std::vector<std::string> drive_names(const std::vector<std::string>& drives) {
  std::vector<std::string> names;
  for (const std::string& drive : drives) {
    const std::string name = name_of(drive);
    const auto before = [&](const std::string& wanted) {
      return std::find(names.begin(), names.end(), wanted) != names.end();
    };
    std::string unique = name;
    for (int i = 2; before(unique); ++i) unique = fmt::format("{}-{}", name, i);
    names.push_back(unique);
  }
  return names;
}

std::filesystem::path make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder)) {
    throw OutputError("the folder cannot be made", folder.string(), "give another -o");
  }
  return folder;
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
  const std::vector<std::string> rows = wanted_rows(arguments);
  std::vector<std::unique_ptr<FrameSource>>
      sources;  // all opened first: a bad path must not cost a run
  for (const std::string& drive : arguments.drives) {
    sources.push_back(DriveArguments{drive, arguments.frames, arguments.cameras}.open());
    require_cameras(sources.back()->info(), "the paper's method");
  }
  // All rows, wanted or not: a bad one must show at once, not after an hour.
  for (const std::string& row : reproduced_rows()) check_row(row);
  std::optional<MlsTimes> mls;
  if (!arguments.mls.empty()) mls = read_mls_times(arguments.mls);
  const std::filesystem::path output = make_folder(arguments.output);
  ProgressBar bar(arguments.quiet, "rows");
  const int total = static_cast<int>(rows.size() * sources.size());
  int done = 0;
  const std::vector<std::string> names = drive_names(arguments.drives);
  std::vector<DriveResults> results;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto& source = sources[i];
    const DriveInfo& info = source->info();
    DriveResults drive{names[i], {}, info.end - info.begin, {}, time_upsampling(*source)};
    for (const Camera& camera : info.calibration.cameras) drive.cameras.push_back(camera.index);
    const std::filesystem::path folder = make_folder(output / ("rows-" + drive.name));
    for (const std::string& row : rows) {
      // One row's pictures are enough to look at.
      const std::filesystem::path page =
          row == "default" ? output / report_file(drive.name) : std::filesystem::path();
      nlohmann::ordered_json result = run_row(*source, row, folder, page);
      if (!result.is_null()) drive.rows.push_back(std::move(result));
      bar.draw(++done, total, row + "  ");
    }
    results.push_back(std::move(drive));
  }
  OutputFile json(output / "results.json", /*force=*/true),
      page(output / "results.md", /*force=*/true);
  page.stream() << write_results_page(results, mls, command_line(arguments), output);
  write_json(json, results_json(results));
  page.commit();
  warnings.add(results_warnings(results), arguments.quiet);
  if (!arguments.quiet) print_out("{}\n", (output / "results.md").string());
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
      ->check(CLI::IsMember(reproduced_rows()));
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
