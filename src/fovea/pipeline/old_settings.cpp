#include "fovea/pipeline/old_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "fovea/core/printable.h"
#include "fovea/core/settings.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

struct OldKey {
  std::string_view key;
  std::string_view new_key;   ///< empty: a constant
  std::string_view constant;  ///< its value
};

constexpr OldKey kOldKeys[] = {
    {"motion.interpolate_navigation", "", "true"},
    {"refinement.target", "",
     "the local map in the default mapper, the previous scan in the paper mapper"},
    {"refinement.visible_only", "",
     "false in the default mapper, foveal.enabled in the paper mapper"},
    {"refinement.upsample_rate", "", "0 in the default mapper, upsample.rate in the paper mapper"},
    {"refinement.voxel", "registration.voxel_m", ""},
    {"refinement.max_correction_translation", "", "2 m"},
    {"refinement.max_correction_rotation", "", "5 degrees"},
    {"ground.sensor_height", "ground.sensor_height_m", ""},
    {"ground.tolerance", "", "0.25 m"},
    {"ground.ransac_iterations", "", "200"},
    {"ground.ransac_max_tilt", "", "10 degrees"},
    {"registration.max_iterations", "", "100"},
    {"registration.max_distance", "", "1 m"},
    {"registration.converged_rotation", "", "0.0001 rad"},
    {"registration.converged_translation", "", "0.001 m"},
    {"registration.neighbors", "", "10"},
    {"registration.plane_epsilon", "", "0.001"},
    {"registration.robust_width", "registration.kernel_width_m", ""},
    {"registration.degenerate_eigenvalue", "", "0.01"},
    {"local_map.keyframe_distance", "local_map.keyframe_distance_m", ""},
    {"local_map.keyframe_rotation", "local_map.keyframe_rotation_deg", ""},
    {"local_map.keyframe_overlap", "", "0.8"},
    {"local_map.max_range", "", "120 m"},
    {"local_map.voxel", "", "0.25 m"},
    {"foveal.near_range", "foveal.near_range_m", ""},
    {"foveal.far_range", "foveal.far_range_m", ""},
    {"foveal.max_incidence", "foveal.max_incidence_deg", ""},
    {"foveal.slices", "foveal.slices_deg", ""},
    {"foveal.camera_0_slices", "foveal.camera_0_slices_deg", ""},
    {"foveal.camera_1_slices", "foveal.camera_1_slices_deg", ""},
    {"foveal.camera_2_slices", "foveal.camera_2_slices_deg", ""},
    {"foveal.camera_3_slices", "foveal.camera_3_slices_deg", ""},
    {"foveal.camera_4_slices", "foveal.camera_4_slices_deg", ""},
    {"foveal.camera_5_slices", "foveal.camera_5_slices_deg", ""},
    {"foveal.camera_6_slices", "foveal.camera_6_slices_deg", ""},
    {"foveal.camera_7_slices", "foveal.camera_7_slices_deg", ""},
    {"foveal.camera_8_slices", "foveal.camera_8_slices_deg", ""},
    {"foveal.camera_9_slices", "foveal.camera_9_slices_deg", ""},
    {"surface.spacing", "surface.spacing_m", ""},
    {"surface.max_edge", "surface.max_edge_m", ""},
    {"surface.planar_edge", "surface.planar_edge_m", ""},
    {"surface.planar_angle", "surface.planar_angle_deg", ""},
    {"upsample.max_edge", "upsample.max_edge_m", ""},
    {"ray_filter.mode", "",
     "the scan's filter in the default mapper, the paper's filter in the paper mapper"},
    {"ray_filter.window", "ray_filter.window_px", ""},
    {"ray_filter.occluding_test", "", "true"},
    {"ray_filter.occluded_test", "", "true"},
    {"texture.views", "", "the mean of all views in the default mapper, one in the paper mapper"},
    {"texture.footprint", "texture.footprint_m", ""},
    {"moving.remove", "dynamic.remove", ""},
    {"moving.range", "dynamic.range_m", ""},
    {"moving.free_scans", "dynamic.free_scans", ""},
    {"map.tile_size", "map.tile_size_m", ""},
    {"map.submap_duration", "fusion.submap_duration_s", ""},
};

const OldKey* find_old(std::string_view key) {
  const auto* found = std::find_if(std::begin(kOldKeys), std::end(kOldKeys),
                                   [&](const OldKey& old) { return old.key == key; });
  return found != std::end(kOldKeys) ? found : nullptr;
}

/// Whether the mapper has the key.
bool has_key(MapperKind mapper, std::string_view key) {
  MapSettings settings = default_settings(mapper);
  const SettingsTable rows = settings_rows(settings);
  const bool is_camera_key = key.starts_with("foveal.camera_") && key.ends_with("_slices_deg");
  return std::any_of(rows.begin(), rows.end(), [&](const Setting& row) {
    return row.key() == key || (is_camera_key && row.key() == kCameraSlicesKey);
  });
}

constexpr MapperKind other_than(MapperKind mapper) {
  return mapper == MapperKind::kPaper ? MapperKind::kDefault : MapperKind::kPaper;
}

std::string_view name_of(MapperKind mapper) {
  return mapper == MapperKind::kPaper ? "paper" : "default";
}

std::optional<std::string_view> value_of(const std::vector<SettingText>& entries,
                                         std::string_view key) {
  for (const SettingText& entry : entries) {
    if (entry.key == key) return entry.value;
  }
  return std::nullopt;
}

/// The mapper that a text is for.
MapperKind mapper_for(const std::vector<SettingText>& entries) {
  const auto says = [&](std::string_view key, std::initializer_list<std::string_view> values) {
    const auto value = value_of(entries, key);
    return value && std::find(values.begin(), values.end(), *value) != values.end();
  };
  const auto quoted = [&](std::string_view key, std::string_view value) {
    return says(key, {fmt::format("'{}'", value), fmt::format("\"{}\"", value)});
  };
  if (value_of(entries, "mapper")) {
    return quoted("mapper", "paper") ? MapperKind::kPaper : MapperKind::kDefault;
  }
  if (quoted("refinement.target", "previous-scan") || quoted("ray_filter.mode", "paper") ||
      quoted("texture.views", "first") || says("surface.spacing", {"0", "0.0"}) ||
      says("foveal.enabled", {"false"})) {
    return MapperKind::kPaper;
  }
  bool of_default = false, of_paper = false;
  for (const SettingText& entry : entries) {
    const OldKey* old = find_old(entry.key);
    const std::string_view key = old != nullptr && !old->new_key.empty() ? old->new_key : entry.key;
    const bool in_default = has_key(MapperKind::kDefault, key);
    const bool in_paper = has_key(MapperKind::kPaper, key);
    of_default |= in_default && !in_paper;
    of_paper |= in_paper && !in_default;
  }
  return of_paper && !of_default ? MapperKind::kPaper : MapperKind::kDefault;
}

/// ConfigError for a key that neither version has, or a new one of the wrong type.
void require_known(const SettingsDocument& document) {
  document.apply(
      [](SettingVisitor& visit) {
        for (const OldKey& old : kOldKeys) visit.is_given(old.key);
        MapperKind mapper{};
        visit("mapper", mapper);
        for (const MapperKind kind : {MapperKind::kDefault, MapperKind::kPaper}) {
          MapSettings settings = default_settings(kind);
          visit_rows(settings_rows(settings), visit);
        }
      },
      [] {}, "see docs/settings.md for the keys");
}

struct Converted {
  std::vector<SettingText> settings;
  std::string comments;  // what has no counterpart
};

Converted convert(const std::vector<SettingText>& entries, MapperKind mapper) {
  Converted converted;
  const auto comment = [&](const SettingText& entry, const std::string& why) {
    converted.comments += fmt::format("# {} = {}: {}\n", entry.key, printable(entry.value), why);
  };
  for (const SettingText& entry : entries) {
    if (entry.key == "mapper") continue;
    const OldKey* old = find_old(entry.key);
    const std::string key(old != nullptr ? old->new_key : entry.key);
    if (key.empty()) {
      comment(entry, fmt::format("a constant now ({})", old->constant));
    } else if (has_key(mapper, key)) {
      converted.settings.push_back({key, entry.value});
    } else {
      comment(entry, fmt::format("{} of the {} mapper", key, name_of(other_than(mapper))));
    }
  }
  return converted;
}

}  // namespace

void explain_unknown_key(MapperKind mapper, std::string_view key) {
  const OldKey* old = find_old(key);
  if (old != nullptr && old->new_key.empty()) {
    throw ConfigError(fmt::format("this key is a constant now ({})", old->constant), key,
                      "remove it");
  }
  const std::string_view now = old != nullptr ? old->new_key : key;
  const MapperKind other = other_than(mapper);
  if (has_key(mapper, now)) {
    throw ConfigError("this key has a new name", key,
                      fmt::format("write {}, or run `fovea settings convert`", now));
  }
  if (has_key(other, now)) {
    throw ConfigError(fmt::format("this key belongs to the {} mapper", name_of(other)), key,
                      fmt::format("use --preset {} and write {}", name_of(other), now));
  }
}

std::string convert_settings(std::string_view text, std::string_view name) {
  const SettingsDocument document = SettingsDocument::from_text(text, name);
  require_known(document);
  const std::vector<SettingText> entries = document.entries();
  const MapperKind mapper = mapper_for(entries);
  const Converted converted = convert(entries, mapper);

  MapSettings defaults = default_settings(mapper);
  const SettingsTable rows = settings_rows(defaults);
  std::set<std::string> keys;
  std::string unsorted;
  for (const SettingText& setting : converted.settings) {
    keys.insert(setting.key);
    unsorted += fmt::format("{} = {}\n", setting.key, setting.value);
  }
  SettingsDocument::from_text(unsorted, fmt::format("{}, converted", name))
      .apply([&](SettingVisitor& visit) { visit_rows(rows, visit); }, [&] { validate_rows(rows); },
             "see docs/settings.md for the keys");

  std::vector<SettingText> settings{{"mapper", fmt::format("\"{}\"", name_of(mapper))}};
  for (SettingText& setting : setting_texts([&](SettingVisitor& v) { visit_rows(rows, v); })) {
    if (keys.contains(setting.key)) settings.push_back(std::move(setting));
  }
  const char* const gap = converted.comments.empty() ? "" : "\n";
  return converted.comments + gap + toml_of(settings);
}

std::string old_keys_table() {
  std::string text = "| earlier key | today |\n| --- | --- |\n";
  for (const OldKey& old : kOldKeys) {
    text += old.new_key.empty() ? fmt::format("| `{}` | constant: {} |\n", old.key, old.constant)
                                : fmt::format("| `{}` | `{}` |\n", old.key, old.new_key);
  }
  return text;
}

}  // namespace fovea
