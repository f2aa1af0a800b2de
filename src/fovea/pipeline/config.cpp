#include "fovea/pipeline/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "fovea/base/errors.h"
#include "fovea/base/settings.h"
#include "fovea/pipeline/config_keys.h"
#include "fovea/pipeline/presets.h"

namespace fovea {
namespace {

void apply(const SettingsDocument& document, MapperOptions& options) {
  MapperOptions result = options;
  document.apply([&](SettingVisitor& visit) { visit_config(visit, result); },
                 [&] { result.validate(); },
                 "see `fovea map --help` and config/default.toml for the keys");
  options = std::move(result);
}

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  std::sort(names.begin(), names.end());
  return names;
}

MapperOptions load_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    MapperOptions options;
    apply_config_text(preset.text, fmt::format("preset {}", name), options);
    return options;
  }
  throw ConfigError(fmt::format("unknown preset '{}'", name), "--preset",
                    fmt::format("give one of {}", fmt::join(preset_names(), ", ")));
}

void apply_config_file(const std::filesystem::path& file, MapperOptions& options) {
  apply(SettingsDocument::from_file(file), options);
}

void apply_config_text(std::string_view text, std::string_view name, MapperOptions& options) {
  apply(SettingsDocument::from_text(text, name), options);
}

void apply_setting(std::string_view setting, MapperOptions& options) {
  apply(SettingsDocument::from_assignment(setting, "upsample.rate=2"), options);
}

std::string to_toml(const MapperOptions& options) {
  MapperOptions copy = options;
  return settings_text([&](SettingVisitor& visit) { visit_config(visit, copy); });
}

}  // namespace fovea
