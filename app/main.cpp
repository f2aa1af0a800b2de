// fovea: the command line. Exit codes: 0 done, 1 failed at run time, 2 wrong usage, 130, 143 and
// 129 ended by SIGINT, SIGTERM and SIGHUP.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "app/commands.h"
#include "app/standard_output.h"
#include "fovea/base/errors.h"
#include "fovea/base/printable.h"
#include "fovea/base/process_memory.h"
#include "fovea/base/version.h"

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

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

int run(int argc, char** argv, fovea::app::Session& session) {
  fovea::reserve_memory(kReserved);
  CLI::App app(
      "Real-time incremental foveal texture mapping: a drive in, a coloured 3D point map out.",
      "fovea");
  app.set_version_flag("--version", std::string("fovea ") + fovea::version());
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  fovea::app::add_map_command(app, session);
  fovea::app::add_info_command(app);
  fovea::app::add_evaluate_command(app);
  fovea::app::add_convert_command(app);
  fovea::app::add_crop_command(app);
  fovea::app::add_export_command(app);
  fovea::app::add_localize_command(app);
  fovea::app::add_merge_command(app);
  fovea::app::add_render_command(app);
  fovea::app::add_recolor_command(app);
  fovea::app::add_repair_command(app);
  fovea::app::add_reproduce_command(app);
  fovea::app::add_upsample_command(app);
  fovea::app::add_register_command(app);
  fovea::app::add_simulate_command(app);
  fovea::app::add_view_command(app, session);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& help) {
    return app.exit(help);  // --help, --version
  } catch (const CLI::ParseError& error) {
    print_error(error.what(), ", command line, see fovea --help");
    return kWrongUsage;
  }
}

/// The exit code of `body`; each error is one line.
template <class Body>
int report_errors(Body&& body) noexcept {
  try {
    return body();
  } catch (const fovea::Error& error) {
    print_error(error.what());
  } catch (const std::bad_alloc&) {
    print_error("out of memory, this machine, map fewer frames or at a lower upsampling rate");
  } catch (const std::exception& error) {
    if (fovea::app::standard_output_failed()) {
      print_error(error.what(), ", standard output, check the disk or the program that reads it");
      return kFailed;
    }
    print_error(error.what(), ", inside fovea, please report this with the command that caused it");
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
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
