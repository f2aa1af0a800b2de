// The settings of the mappers: one row for each key.
#pragma once

#include <array>

#include "fovea/core/settings_table.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea {

enum class MapperKind {
  kDefault,  ///< pipeline/mapper.h
  kPaper,    ///< the paper and nothing else
};

constexpr auto names_of(MapperKind) {
  return std::array{EnumName<MapperKind>{MapperKind::kDefault, "default"},
                    EnumName<MapperKind>{MapperKind::kPaper, "paper"}};
}
constexpr auto names_of(RegistrationMethod) {
  return std::array{EnumName<RegistrationMethod>{RegistrationMethod::kGicp, "gicp"},
                    EnumName<RegistrationMethod>{RegistrationMethod::kPointToPoint, "icp"},
                    EnumName<RegistrationMethod>{RegistrationMethod::kPointToPlane, "plane"}};
}
constexpr auto names_of(GroundMethod) {
  return std::array{EnumName<GroundMethod>{GroundMethod::kHeight, "height"},
                    EnumName<GroundMethod>{GroundMethod::kRansac, "ransac"}};
}
constexpr auto names_of(ImageSampling) {
  return std::array{EnumName<ImageSampling>{ImageSampling::kBilinear, "bilinear"},
                    EnumName<ImageSampling>{ImageSampling::kNearest, "nearest"}};
}

/// Stands for the keys of all cameras K.
inline constexpr const char* kCameraSlicesKey = "foveal.camera_K_slices_deg";

/// All rows of the mapper that the settings are for, bound to them.
SettingsTable settings_rows(MapSettings& settings);

/// A mapper's settings, each with the default of its row.
MapSettings default_settings(MapperKind mapper);

/// The mapper that the settings are for.
MapperKind mapper_of(const MapSettings& settings);

}  // namespace fovea
