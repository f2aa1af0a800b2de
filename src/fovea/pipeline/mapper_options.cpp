#include "fovea/pipeline/mapper_options.h"

#include <fmt/format.h>

#include <numbers>

#include "fovea/base/errors.h"
#include "fovea/base/point_cloud.h"

namespace fovea {
namespace {

[[noreturn]] void reject(const char* what, const char* field, const char* remedy) {
  throw ConfigError(what, field, remedy);
}

RegistrationMethod method_of_variant(int number) {
  // The paper's Table II: E0-E3 GICP, E4-E7 point to point, E8-E11 point to plane.
  switch (number / 4) {
    case 0:
      return RegistrationMethod::kGicp;
    case 1:
      return RegistrationMethod::kPointToPoint;
    default:
      return RegistrationMethod::kPointToPlane;
  }
}

}  // namespace

void RefinementOptions::validate() const {
  if (upsample_rate < 0 || upsample_rate > 5) {
    reject("a rate is out of range", "refinement.upsample_rate", "give 0 to 5");
  }
  if (!(voxel >= 0 && voxel <= 10)) {
    reject("a voxel size is out of range", "refinement.voxel", "give metres from 0 (off) to 10");
  }
  if (!(max_correction_translation > 0)) {
    reject("a limit is not positive", "refinement.max_correction_translation", "give metres");
  }
  if (!(max_correction_rotation > 0 && max_correction_rotation <= std::numbers::pi)) {
    reject("an angle is out of range", "refinement.max_correction_rotation",
           "give degrees above 0 and up to 180");
  }
  ground.validate();
  registration.validate();
  local_map.validate();
}

void MapperOptions::validate() const {
  if (!(max_damaged_share >= 0 && max_damaged_share <= 1)) {
    reject("a share is out of range", "input.max_damaged_share", "give 0 to 1");
  }
  refinement.validate();
  foveal.validate();
  for (const auto& [camera, slices] : camera_slices) {
    FovealOptions one = foveal;
    one.slices = slices;
    one.validate();
  }
  upsample.validate();
  ray_filter.validate();
  moving.validate();
  surface.validate();
  texture.validate();
  fusion.validate();
  if (!(tile_size >= 0.5 && tile_size <= 65)) {
    reject("a size is out of range", "map.tile_size", "give metres from 0.5 to 65");
  }
}

FovealOptions foveal_options_of(const MapperOptions& options, int camera) {
  FovealOptions foveal = options.foveal;
  const auto own = options.camera_slices.find(camera);
  if (own != options.camera_slices.end()) foveal.slices = own->second;
  if (camera == kNoCamera) foveal.slices.clear();
  return foveal;
}

const std::vector<std::string>& variant_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"baseline-gicp", "baseline-icp", "baseline-plane"};
    for (int i = 0; i < 12; ++i) all.push_back(fmt::format("E{}", i));
    return all;
  }();
  return names;
}

void apply_variant(std::string_view name, MapperOptions& options) {
  const auto& names = variant_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw ConfigError(fmt::format("unknown variant '{}'", name), "--variant",
                      "give E0 to E11, baseline-gicp, baseline-icp or baseline-plane");
  }
  const int row = static_cast<int>(found - names.begin());
  const bool baseline = row < 3;
  const int number = baseline ? row * 4 : row - 3;

  options.refinement.registration.method = method_of_variant(number);
  options.refinement.target = RegistrationTarget::kPreviousScan;
  options.refinement.registration.robust_width = 0;
  options.refinement.registration.max_points = 0;
  options.refinement.voxel = 0;
  options.refinement.visible_only = !baseline;
  options.refinement.upsample_rate = baseline ? 0 : number % 4;
  options.surface.spacing = 0;
  options.upsample.rate = options.refinement.upsample_rate;

  options.foveal_enabled = !baseline;
  options.foveal = FovealOptions{};  // whole camera view, no incidence limit
  options.foveal.far_range = 15;
  options.camera_slices.clear();
  options.ray_filter = RayFilterOptions{};  // paper mode, M = 5, c = 2
  options.texture.views = TextureViews::kFirst;
  if (baseline) options.ray_filter.mode = RayFilterMode::kOff;
  options.moving.remove = false;
  options.fusion.enabled = false;
  options.check_calibration = false;
}

}  // namespace fovea
