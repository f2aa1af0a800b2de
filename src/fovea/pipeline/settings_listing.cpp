#include "fovea/pipeline/settings_listing.h"

#include <fmt/format.h>

#include "fovea/pipeline/old_settings.h"

namespace fovea {
namespace {

constexpr const char* kPageHead =
    R"(# Settings

This page is the output of `fovea settings docs`. It has one row for each key.

`fovea map` takes settings from these places. Later ones win:

1. `--preset default|paper|realtime`: a file of [config](../config), see [presets.md](presets.md).
2. `--config FILE.toml`: the keys that differ from the preset.
3. `--variant`: a row of the paper's table.
4. `--set key=value`: one key, may be repeated.

`mapper = "default"` or `mapper = "paper"` at the head of a file selects the mapper, with the defaults of its table.
`fovea info MAP` prints the settings of a map. `fovea settings list` prints all keys with their defaults in TOML.
Lengths are in meters (`_m`), angles in degrees (`_deg`), durations in seconds (`_s`), windows in pixels (`_px`).
)";

}  // namespace

std::string settings_listing(MapperKind mapper) {
  MapSettings settings = default_settings(mapper);
  const char* name = mapper == MapperKind::kPaper ? "paper" : "default";
  return fmt::format(
      "# The settings of the {} mapper with their defaults.\n"
      "# `fovea settings list --mapper {}` prints them.\n\nmapper = \"{}\"\n\n{}",
      name, name, name, commented_toml(settings_rows(settings)));
}

std::string settings_page() {
  MapSettings mapper = default_settings(MapperKind::kDefault);
  MapSettings paper = default_settings(MapperKind::kPaper);
  return fmt::format(
      "{}\n## The default mapper\n\n{}\n## The paper mapper\n\n`--preset paper` selects it, with "
      "the slices of the paper's figure (`config/paper.toml`).\n\n{}\n"
      "## Keys of earlier versions\n\nA configuration with one of these keys is an error. "
      "`fovea settings convert OLD.toml` prints it in\ntoday's keys. "
      "Maps of earlier versions are read as they are.\n\n{}",
      kPageHead, markdown_list(settings_rows(mapper)), markdown_list(settings_rows(paper)),
      old_keys_table());
}

}  // namespace fovea
