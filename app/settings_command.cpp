// fovea settings: lists the settings, and converts files of earlier versions.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/print.h"
#include "fovea/core/input_file.h"
#include "fovea/core/text_encoding.h"
#include "fovea/pipeline/old_settings.h"
#include "fovea/pipeline/settings_listing.h"

namespace fovea::app {
namespace {

void convert(const std::string& file) {
  const std::vector<std::uint8_t> bytes = InputFile(file, kSettingsFile).bytes();
  const std::string text(bytes.begin(), bytes.end());
  print_lines(convert_settings(without_byte_order_mark(text, file), file));
}

}  // namespace

void add_settings_command(CLI::App& app, Session&) {
  CLI::App* command = app.add_subcommand("settings", "List the settings, or convert old ones");
  command->require_subcommand(1);

  auto mapper = std::make_shared<std::string>("default");
  CLI::App* list = command->add_subcommand("list", "Print all keys with their defaults in TOML");
  list->add_option("--mapper", *mapper, "default or paper")
      ->capture_default_str()
      ->check(CLI::IsMember({"default", "paper"}));
  list->callback([mapper] {
    print_lines(settings_listing(*mapper == "paper" ? MapperKind::kPaper : MapperKind::kDefault));
  });

  command->add_subcommand("docs", "Print the page docs/settings.md")->callback([] {
    print_lines(settings_page());
  });

  auto file = std::make_shared<std::string>();
  CLI::App* converter = command->add_subcommand(
      "convert", "Print a configuration of an earlier version in today's keys");
  converter->add_option("OLD.toml", *file, "Configuration to convert")->required();
  converter->callback([file] { convert(*file); });
}

}  // namespace fovea::app
