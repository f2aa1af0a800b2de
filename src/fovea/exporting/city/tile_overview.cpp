#include "fovea/exporting/city/tile_overview.h"

#include "fovea/core/errors.h"
#include "fovea/core/output_file.h"
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

void write_tile_overview(const std::filesystem::path& map, const std::filesystem::path& overview,
                         double tile_size) {
  const std::vector<ExportPoint> points =
      overview_points(MapReader(map), overview_spacing(tile_size), kCityExposure);
  OutputFile file(overview, /*force=*/true);
  file.stream() << make_glb(points, /*with_sources=*/true).bytes;
  file.commit();
}

}  // namespace fovea
