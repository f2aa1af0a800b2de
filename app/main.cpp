// fovea: the command line. Exit codes: 0 done, 1 failed at run time, 2 wrong usage, 74 the machine
// failed in a step of a job engine, 130, 143 and 129 ended by SIGINT, SIGTERM and SIGHUP.
#include <sysexits.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include "app/commands.h"
#include "app/error_line.h"
#include "app/standard_output.h"
#include "fovea/core/printable.h"
#include "fovea/core/process_memory.h"
#include "fovea/core/unfinished_output.h"
#include "fovea/errors.h"
#include "fovea/platform.h"

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kMachineFailed = EX_IOERR;  // as a full disk: the command may end well later

/// One line on standard error, whatever a library wrote. Must not throw: it is the last resort.
void print_error(const char* message, const char* where_and_remedy = "") noexcept {
  std::fputs("fovea: error: ", stderr);
  for (std::string_view rest = message; !rest.empty();) {
    const fovea::Character character = fovea::first_character(rest);
    if (character.is_control) {
      std::fputc(' ', stderr);
    } else {
      std::fwrite(rest.data(), 1, character.bytes, stderr);
    }
    rest.remove_prefix(character.bytes);
  }
  std::fputs(where_and_remedy, stderr);
  std::fputc('\n', stderr);
}

/// Of addresses: about what a map of a short drive takes while it is made (docs/performance.md).
constexpr std::size_t kReserved = std::size_t{256} << 20;

constexpr const char* kStrictHelp = "Warnings are errors: the exit code is 1 (outputs are kept)";

int run(int argc, char** argv, fovea::app::Session& session) {
  fovea::reserve_memory(kReserved);
  CLI::App app(
      "Real-time incremental foveal texture mapping: a drive in, a coloured 3D point map out.",
      "fovea");
  app.set_version_flag("--version", std::string("fovea ") + fovea::version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  for (const fovea::app::AddCommand add : fovea::app::commands()) add(app, session);
  app.add_flag("--strict", session.warnings.strict, kStrictHelp);
  for (CLI::App* subcommand : app.get_subcommands({})) {
    subcommand->add_flag("--strict", session.warnings.strict, kStrictHelp);
  }
  try {
    app.parse(argc, argv);
    const std::string warnings = session.warnings.error();
    if (warnings.empty()) return 0;
    print_error(warnings.c_str());
    return kFailed;
  } catch (const CLI::Success& help) {
    return app.exit(help);  // --help, --version
  } catch (const CLI::ParseError& error) {
    print_error(error.what(), ", command line, see fovea --help");
    return kWrongUsage;
  }
}

/// The first argument that is no option.
std::string_view command_of(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] != '-') return argv[i];
  }
  return "";
}

/// Whether a job engine runs this command (app/job_arguments.h).
bool has_if_missing(int argc, char** argv) {
  return std::find(argv, argv + argc, std::string_view("--if-missing")) != argv + argc;
}

std::string_view command;  // that runs
bool is_step = false;  // of a job engine, which needs to tell failures of the machine from others

int exit_code_of(const std::exception& error) {
  return is_step && fovea::app::is_of_machine(error) ? kMachineFailed : kFailed;
}

/// For an error in a thread or a destructor, which no function can catch.
[[noreturn]] void end_with_error() {
  int code = kFailed;
  try {
    fovea::discard_unfinished_outputs();
    if (std::current_exception() != nullptr) throw;
    print_error("the program ended, inside fovea, please report this with the command");
  } catch (const std::exception& error) {
    code = exit_code_of(error);
    print_error(fovea::app::error_line(error, command).c_str());
  } catch (...) {
    print_error("an unknown error, inside fovea, please report this with the command");
  }
  std::_Exit(code);
}

/// The exit code of `body`; each error is one line.
template <class Body>
int report_errors(Body&& body) noexcept {
  try {
    try {
      return body();
    } catch (const std::exception& error) {
      if (fovea::app::standard_output_failed()) {
        print_error(error.what(), ", standard output, check the disk or the program that reads it");
      } else {
        print_error(fovea::app::error_line(error, command).c_str());
      }
      return exit_code_of(error);
    }
  } catch (...) {  // of the line itself
    print_error("out of memory, this machine, end other programs");
  }
  return is_step ? kMachineFailed : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  command = command_of(argc, argv);
  is_step = has_if_missing(argc, argv);
  std::set_terminate(end_with_error);
  fovea::app::prepare_standard_streams();
  return report_errors([&] {
    fovea::app::Session session;  // before any thread starts: it blocks signals for all threads
    const int code = report_errors([&] {
      const int done = run(argc, argv, session);
      fovea::app::finish_standard_output();
      return done;
    });
    return session.interrupt.exit_code(code);
  });
}
