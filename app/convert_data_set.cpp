#include "app/convert_data_set.h"

#include <memory>
#include <string>
#include <vector>

#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/data_sets/data_set.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

struct DataSetArguments {
  std::string root, output;
  DataSetOptions options;
  bool list = false, quiet = false;
};

struct DataSet {
  const char *name, *description;
  DataSetFigures (*convert)(const DataSetOptions&);
  std::vector<std::string> (*scenes)(const std::filesystem::path& root);
};

void run(const DataSet& data_set, const DataSetArguments& arguments, Warnings& warnings) {
  if (arguments.list) {
    for (const std::string& scene : data_set.scenes(arguments.root)) print_out("{}\n", scene);
    return;
  }
  if (arguments.output.empty()) throw ConfigError("there is no folder to make", "-o", "name one");
  check_files({{arguments.root}, {}, {arguments.output}});
  DataSetOptions options = arguments.options;
  options.root = arguments.root;
  options.output = arguments.output;
  const DataSetFigures figures = [&] {
    ProgressBar bar(arguments.quiet, "scans");
    options.progress = [&](int done, int all) { bar.draw(done, all); };
    return data_set.convert(options);
  }();
  warnings.add(figures, "", arguments.quiet);
  if (arguments.quiet) return;
  print_out("{}: {} scans, {} images and {} poses\n", arguments.output, figures.scans,
            figures.images, figures.poses);
  if (figures.dropped.total() > 0) print_out("points left out: {}\n", reasons_of(figures.dropped));
}

void add(CLI::App& parent, const DataSet& data_set, Session& session) {
  auto arguments = std::make_shared<DataSetArguments>();
  DataSetOptions& options = arguments->options;
  CLI::App* command = parent.add_subcommand(data_set.name, data_set.description);
  command->add_option("ROOT", arguments->root, "Folder of the data set")->required();
  command->add_option("--scene", options.scene, "The scene (default: the only one)");
  command->add_flag("--list", arguments->list, "Print the names of the scenes, and make nothing");
  command->add_option("-o,--output", arguments->output, "Folder to make (docs/drives.md)")
      ->type_name("DIR");
  command
      ->add_option("--start", options.start, "Leave out what comes before, s from the first scan")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--duration", options.duration, "Length of the part to convert, s")
      ->check(CLI::PositiveNumber);
  command->add_flag("--force", options.force, "Replace DIR");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback(
      [arguments, data_set, &session] { run(data_set, *arguments, session.warnings); });
}

}  // namespace

void add_data_set_commands(CLI::App& convert, Session& session) {
  add(convert, {"nuscenes", "A scene of nuScenes", &convert_nuscenes, &nuscenes_scenes}, session);
  add(convert, {"kitti360", "A sequence of KITTI-360", &convert_kitti360, &kitti360_scenes},
      session);
}

}  // namespace fovea::app
