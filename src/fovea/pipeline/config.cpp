#include "fovea/pipeline/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "fovea/core/settings.h"
#include "fovea/errors.h"
#include "fovea/pipeline/old_settings.h"
#include "fovea/pipeline/presets.h"
#include "fovea/pipeline/settings_rows.h"

namespace fovea {
namespace {

constexpr const char* kMapperKey = "mapper";

void apply(const SettingsDocument& document, MapSettings& settings) {
  MapSettings result = settings;
  MapperKind mapper = mapper_of(settings);
  document.apply(
      [&](SettingVisitor& visit) {
        visit(kMapperKey, mapper);
        if (mapper != mapper_of(result)) result = default_settings(mapper);
        visit_rows(settings_rows(result), visit);
      },
      [&] { validate_rows(settings_rows(result)); }, "see docs/settings.md for the keys",
      [&](std::string_view key) { explain_unknown_key(mapper, key); });
  settings = std::move(result);
}

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  std::sort(names.begin(), names.end());
  return names;
}

MapSettings load_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    MapSettings settings;
    apply_config_text(preset.text, fmt::format("preset {}", name), settings);
    return settings;
  }
  throw ConfigError(fmt::format("unknown preset '{}'", name), "--preset",
                    fmt::format("give one of {}", fmt::join(preset_names(), ", ")));
}

void apply_config_file(const std::filesystem::path& file, MapSettings& settings) {
  apply(SettingsDocument::from_file(file), settings);
}

void apply_config_text(std::string_view text, std::string_view name, MapSettings& settings) {
  apply(SettingsDocument::from_text(text, name), settings);
}

void apply_setting(std::string_view setting, MapSettings& settings) {
  apply(SettingsDocument::from_assignment(setting, "surface.spacing_m=0.03"), settings);
}

MapSettings stored_settings(std::string_view text, std::string_view name) {
  MapSettings settings;
  apply_config_text(convert_settings(text, name), name, settings);
  // Maps of versions before the periphery have none.
  const bool is_older = text.find("periphery_range_m") == std::string_view::npos;
  if (is_older && !settings.is_paper()) apply_setting("foveal.periphery_range_m=0", settings);
  return settings;
}

void validate(const MapSettings& settings) {
  MapSettings copy = settings;
  validate_rows(settings_rows(copy));
}

std::string to_toml(const MapSettings& settings) {
  MapSettings copy = settings;
  MapperKind mapper = mapper_of(settings);
  return settings_text([&](SettingVisitor& visit) {
    visit(kMapperKey, mapper);
    visit_rows(settings_rows(copy), visit);
  });
}

}  // namespace fovea
