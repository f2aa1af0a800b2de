#include "fovea/pipeline/paper_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fovea/errors.h"

namespace fovea {

const std::vector<std::string>& variant_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"baseline-gicp", "baseline-icp", "baseline-plane"};
    for (int i = 0; i < 12; ++i) all.push_back(fmt::format("E{}", i));
    return all;
  }();
  return names;
}

void apply_variant(std::string_view name, PaperOptions& options) {
  const auto& names = variant_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw ConfigError(fmt::format("unknown variant '{}'", name), "--variant",
                      "give E0 to E11, baseline-gicp, baseline-icp or baseline-plane");
  }
  // Table II: E0-E3 GICP, E4-E7 point to point, E8-E11 point to plane, each with rates 0 to 3.
  constexpr std::array kMethods{RegistrationMethod::kGicp, RegistrationMethod::kPointToPoint,
                                RegistrationMethod::kPointToPlane};
  const auto row = static_cast<std::size_t>(found - names.begin());
  const bool is_baseline = row < kMethods.size();
  const std::size_t number = is_baseline ? 4 * row : row - kMethods.size();
  options.registration = kMethods[number / 4];
  options.upsample.rate = static_cast<int>(number % 4);
  options.foveal_enabled = !is_baseline;
  options.foveal = PaperOptions().foveal;  // the whole view, without a limit of incidence
  options.ray_filter = RayFilterOptions();
}

}  // namespace fovea
