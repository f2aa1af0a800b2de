#include "app/job_arguments.h"

#include <filesystem>

#include "app/print.h"

namespace fovea::app {

CLI::Option* add_if_missing_option(CLI::App& command, bool& if_missing) {
  return command.add_flag("--if-missing", if_missing, "Do nothing if the output exists");
}

CLI::Option* add_scratch_option(CLI::App& command, std::string& scratch) {
  return command
      .add_option("--scratch", scratch,
                  "For outputs on a shared folder: the map grows in DIR, without a log, and is "
                  "copied when it is whole")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
}

bool is_done(const std::string& output, bool if_missing, bool quiet) {
  std::error_code ignored;
  if (!if_missing || !std::filesystem::exists(output, ignored)) return false;
  if (!quiet) print_out("{} exists: nothing to do\n", output);
  return true;
}

}  // namespace fovea::app
