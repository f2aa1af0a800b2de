// fovea catalog: what a planner of many drives needs of one.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/job_arguments.h"
#include "app/print.h"
#include "fovea/core/output_file.h"
#include "fovea/drive/command_files.h"
#include "fovea/pipeline/drive_catalog.h"

namespace fovea::app {
namespace {

struct CatalogArguments {
  DriveArguments drive;
  std::string output;
  bool if_missing = false, force = false, quiet = false;
};

void run(const CatalogArguments& arguments, Warnings& warnings) {
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  check_files(
      {{arguments.drive.drive}, {{arguments.output, ContentKind::kCatalog, arguments.force}}});
  const DriveCatalog catalog = catalog_of(*arguments.drive.open());
  OutputFile output(arguments.output, arguments.force);
  output.stream() << to_json(catalog);
  output.commit();
  if (!arguments.quiet) {
    print_out("{}: {} frames, {:.0f} m\n", arguments.output, catalog.frames, catalog.length);
  }
  warnings.add(catalog, "note: ", arguments.quiet);
}

}  // namespace

void add_catalog_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<CatalogArguments>();
  CLI::App* command = app.add_subcommand(
      "catalog", "Write where a drive goes and what it is, for a planner of many drives");
  command->add_option("DRIVE", arguments->drive.drive, "The drive (docs/drives.md)")->required();
  command->add_option("-o,--output", arguments->output, "File to write")
      ->required()
      ->type_name("FILE.json");
  command
      ->add_option("--cameras", arguments->drive.cameras,
                   "As for map (default: those that map takes)")
      ->type_name("K,...");
  add_if_missing_option(*command, arguments->if_missing);
  command->add_flag("--force", arguments->force, "Overwrite FILE.json");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
