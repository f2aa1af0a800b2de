#include "app/convert_data_set.h"

#include <memory>
#include <string>

#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/data_sets/data_set.h"

namespace fovea::app {
namespace {

struct DataSetArguments {
  std::string root, output;
  DataSetOptions options;
  bool quiet = false;
};

using Convert = DataSetFigures (*)(const DataSetOptions&);

void run(Convert convert, const DataSetArguments& arguments, Warnings& warnings) {
  check_files({{arguments.root}, {}, {arguments.output}});
  DataSetOptions options = arguments.options;
  options.root = arguments.root;
  options.output = arguments.output;
  const DataSetFigures figures = [&] {
    ProgressBar bar(arguments.quiet, "scans");
    options.progress = [&](int done, int all) { bar.draw(done, all); };
    return convert(options);
  }();
  warnings.add(figures, "", arguments.quiet);
  if (arguments.quiet) return;
  print_out("{}: {} scans, {} images and {} poses\n", arguments.output, figures.scans,
            figures.images, figures.poses);
  if (figures.dropped.total() > 0) print_out("points left out: {}\n", reasons_of(figures.dropped));
}

void add(CLI::App& parent, const char* name, const char* description, Convert convert,
         Session& session) {
  auto arguments = std::make_shared<DataSetArguments>();
  DataSetOptions& options = arguments->options;
  CLI::App* command = parent.add_subcommand(name, description);
  command->add_option("ROOT", arguments->root, "Folder of the data set")->required();
  command->add_option("--scene", options.scene, "The scene (default: the only one)");
  command->add_option("-o,--output", arguments->output, "Folder to make (docs/drives.md)")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--start", options.start, "Leave out what comes before, s from the first scan")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--duration", options.duration, "Length of the part to convert, s")
      ->check(CLI::PositiveNumber);
  command->add_flag("--force", options.force, "Replace DIR");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, convert, &session] { run(convert, *arguments, session.warnings); });
}

}  // namespace

void add_data_set_commands(CLI::App& convert, Session& session) {
  add(convert, "nuscenes", "A scene of nuScenes", &convert_nuscenes, session);
  add(convert, "kitti360", "A sequence of KITTI-360", &convert_kitti360, session);
}

}  // namespace fovea::app
