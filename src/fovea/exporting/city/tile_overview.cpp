#include "fovea/exporting/city/tile_overview.h"

#include "fovea/core/output_file.h"
#include "fovea/errors.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/node_points.h"

namespace fovea {

ExposureChoice exposure_of_city(const ExposureChoice& chosen) {
  if (chosen.kind == ExposureChoice::Kind::kAuto) return kCityExposure;
  if (chosen.kind != ExposureChoice::Kind::kFrame) return chosen;
  throw ConfigError("the frames of a city have no common numbers", "--exposure",
                    "give auto or stops");
}

std::vector<ExportPoint> overview_points(const MapReader& map, double spacing,
                                         const ExposureChoice& exposure) {
  const PointChoice choice{.include_uncolored = true, .exposure = exposure};
  const PointStream stream(map, choice);
  LeafReader leaves(stream);
  TileNode root = make_tile_tree(map);
  const auto nothing = [](const TileNode&, const std::vector<ExportPoint>&) {};
  std::vector<ExportPoint> points;
  if (root.is_leaf()) {
    points = leaves.read(root);
  } else {
    // The root's own grid may be coarser.
    for (const TileNode& child : root.children) {
      const std::vector<ExportPoint> below = for_each_node(child, leaves, nothing);
      points.insert(points.end(), below.begin(), below.end());
    }
  }
  root.spacing = spacing;
  return thinned(points, root);
}

namespace {

constexpr std::size_t kHalvings = 7;  // the coarsest grid has one cell for the whole tile

struct LeveledPoints {
  std::vector<ExportPoint> points;  // those of the coarsest level first
  std::vector<std::size_t> levels;  // how many points each level has, the finest one first
};

/// Orders points so that the first ones are a coarser picture. Each level is thinned by a grid of
/// twice the spacing of the level below.
LeveledPoints in_levels(std::vector<ExportPoint> points, const Eigen::Vector3d& low,
                        double spacing) {
  LeveledPoints leveled{{}, {points.size()}};
  std::vector<std::vector<ExportPoint>> dropped;  // by level
  for (std::size_t level = 1; level <= kHalvings; ++level) {
    std::vector<bool> is_kept(points.size());
    spacing *= 2;
    for (const std::uint32_t number : thinned_numbers(points, low, spacing)) is_kept[number] = true;
    std::vector<ExportPoint> kept;
    dropped.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      (is_kept[i] ? kept : dropped.back()).push_back(points[i]);
    }
    points = std::move(kept);
    leveled.levels.push_back(points.size());
  }
  leveled.points = std::move(points);
  for (auto of_level = dropped.rbegin(); of_level != dropped.rend(); ++of_level) {
    leveled.points.insert(leveled.points.end(), of_level->begin(), of_level->end());
  }
  return leveled;
}

}  // namespace

std::string make_overview(const std::filesystem::path& map, double tile_size,
                          const ExposureChoice& exposure) {
  const double spacing = overview_spacing(tile_size);
  const LeveledPoints leveled = in_levels(overview_points(MapReader(map), spacing, exposure),
                                          Eigen::Vector3d::Constant(-tile_size / 2), spacing);
  return make_glb(leveled.points, /*with_sources=*/true, leveled.levels).bytes;
}

void write_tile_overview(const std::filesystem::path& map, const std::filesystem::path& overview,
                         double tile_size) {
  const std::string bytes = make_overview(map, tile_size, kCityExposure);
  OutputFile file(overview, /*force=*/true);
  file.stream() << bytes;
  file.commit();
}

}  // namespace fovea
