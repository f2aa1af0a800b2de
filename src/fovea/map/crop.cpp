#include "fovea/map/crop.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

/// The numbers of a text that commas and spaces part; ConfigError that names the option.
std::vector<double> numbers_of(std::string_view text, const char* option, const char* form) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  const std::optional<std::vector<double>> numbers = numbers_from_text(spaced);
  if (!numbers || std::any_of(numbers->begin(), numbers->end(),
                              [](double number) { return !std::isfinite(number); })) {
    throw ConfigError(fmt::format("'{}' is not a list of numbers", text), option, form);
  }
  return *numbers;
}

}  // namespace

CropRegion CropRegion::box(std::string_view text) {
  constexpr const char* kForm = "give x0,y0,z0,x1,y1,z1 in metres, the lower corner first";
  const std::vector<double> numbers = numbers_of(text, "--box", kForm);
  CropRegion region;
  if (numbers.size() == 6) {
    region.low_ = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
    region.high_ = Eigen::Vector3d(numbers[3], numbers[4], numbers[5]);
  }
  if (numbers.size() != 6 || !(region.low_.array() < region.high_.array()).all()) {
    throw ConfigError(fmt::format("'{}' is no box", text), "--box", kForm);
  }
  region.text_ = fmt::format("box {}", text);
  return region;
}

CropRegion CropRegion::polygon(std::string_view text) {
  constexpr const char* kForm = "give at least three corners: \"x,y x,y x,y\", in metres";
  const std::vector<double> numbers = numbers_of(text, "--polygon", kForm);
  if (numbers.size() < 6 || numbers.size() % 2 != 0) {
    throw ConfigError(fmt::format("'{}' is no polygon", text), "--polygon", kForm);
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  CropRegion region;
  region.low_ = Eigen::Vector3d(kAny, kAny, -kAny);
  region.high_ = -region.low_;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    const Eigen::Vector2d corner(numbers[i], numbers[i + 1]);
    region.polygon_.push_back(corner);
    region.low_.head<2>() = region.low_.head<2>().cwiseMin(corner);
    region.high_.head<2>() = region.high_.head<2>().cwiseMax(corner);
  }
  region.text_ = fmt::format("polygon {}", text);
  return region;
}

bool CropRegion::contains(const Eigen::Vector3d& p) const {
  if (!((p.array() >= low_.array()).all() && (p.array() <= high_.array()).all())) return false;
  if (polygon_.empty()) return true;
  bool inside = false;
  for (std::size_t i = 0, j = polygon_.size() - 1; i < polygon_.size(); j = i++) {
    const Eigen::Vector2d &a = polygon_[i], &b = polygon_[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    const double crossing = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (p.x() < crossing) inside = !inside;
  }
  return inside;
}

CropFigures crop_map(const MapReader& map, const CropRegion& region, MapWriter& output) {
  CropFigures figures;
  const auto held_state = map.hold_state();
  const std::vector<RigidMotion> T_local_submap = copy_all_but_tiles(map, output);
  output.put_meta(meta_key::kCrop, region.text());
  map.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < tile.size(); ++i) {
      const Eigen::Vector3d p_submap = tile.origin + tile.position_at(i).cast<double>();
      if (region.contains(T_local_submap[id.submap] * p_submap)) kept.push_back(i);
    }
    figures.points += kept.size();
    figures.left_out += tile.size() - kept.size();
    if (kept.empty()) return;
    TilePoints inside = tile;
    inside.keep(kept);
    output.put_tile(id, inside);
  });
  output.finish();
  return figures;
}

}  // namespace fovea
