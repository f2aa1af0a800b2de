#include "fovea/exporting/tileset/tileset_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/base/output_folder.h"
#include "fovea/base/version.h"
#include "fovea/exporting/tileset/glb.h"
#include "fovea/exporting/tileset/morton_sort.h"

namespace fovea {
namespace {

constexpr double kMaxSpan = 1e6;  // m

CubeGrid grid_around(const PointStream& points) {
  Eigen::AlignedBox3d box;
  points.for_each_block([&](std::span<const ExportPoint> block) {
    for (const ExportPoint& point : block) box.extend(point.position);
  });
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero().eval());
  CubeGrid grid(box);
  if (!(grid.edge <= kMaxSpan)) {
    throw InputError(fmt::format("the map's points lie up to {:.0f} km apart", grid.edge / 1000),
                     "the map's tiles", "leave stray points out by --where");
  }
  return grid;
}

std::string uri(const std::string& tile) { return "tiles/" + tile + ".glb"; }

std::string bounding_volume(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d center = box.center(), half = box.sizes() / 2;
  return fmt::format(R"("boundingVolume":{{"box":[{},{},{},{},0,0,0,{},0,0,0,{}]}})", center.x(),
                     center.y(), center.z(), half.x(), half.y(), half.z());
}

void append_tiles(std::string& json, const std::vector<OctreeTile>& tiles);

/// What a tile's object has between its braces.
void append_tile(std::string& json, const OctreeTile& tile) {
  json += fmt::format(R"({},"geometricError":{},"content":{{"uri":"{}"}})",
                      bounding_volume(tile.box), tile.spacing, uri(tile.name));
  if (!tile.children.empty()) append_tiles(json, tile.children);
}

void append_tiles(std::string& json, const std::vector<OctreeTile>& tiles) {
  json += ",\"children\":[";
  for (const OctreeTile& tile : tiles) {
    json += &tile == &tiles.front() ? "\n{" : ",\n{";
    append_tile(json, tile);
    json += '}';
  }
  json += ']';
}

/// Column by column, as glTF and 3D Tiles have matrices.
std::string transform(const GeodeticPoint& origin) {
  const Eigen::Matrix4d T = T_ecef_enu(origin).matrix();
  return fmt::format("\"transform\":[{}],", fmt::join(T.data(), T.data() + T.size(), ","));
}

std::string tileset_json(const std::vector<OctreeTile>& roots, const CubeGrid& grid,
                         const std::optional<GeodeticPoint>& origin) {
  std::string json = fmt::format(
      R"({{"asset":{{"version":"1.1","generator":"fovea {}"}},"geometricError":{},"root":{{)",
      version(), grid.edge);
  if (origin) json += transform(*origin);
  json += R"("refine":"REPLACE",)";
  if (roots.size() == 1) {
    append_tile(json, roots.front());
  } else {
    Eigen::AlignedBox3d box(grid.low, grid.low + Eigen::Vector3d::Constant(grid.edge));
    for (const OctreeTile& root : roots) box.extend(root.box);
    json += fmt::format(R"({},"geometricError":{})", bounding_volume(box), grid.edge);
    if (!roots.empty()) append_tiles(json, roots);
  }
  return json + "}}\n";
}

}  // namespace

TilesetFigures write_tileset(const MapReader& map, const std::filesystem::path& path,
                             const TilesetOptions& options) {
  if (options.points.crs != Crs::kLocal) {
    throw std::invalid_argument("a tileset's points are local, its root is placed on earth");
  }
  OutputFolder folder(path, options.force, {"tileset.json", "tiles"});
  const PointStream points(map, options.points);
  const CubeGrid grid = grid_around(points);
  MortonSort sorted(folder.partial(), options.sort_points);
  points.for_each_block([&](std::span<const ExportPoint> block) {
    for (const ExportPoint& point : block) sorted.add({grid.cell(point.position), point.color});
  });
  sorted.finish();

  TilesetFigures figures{points.figures(), 0};
  const auto write_tile = [&](const std::string& name, const std::vector<CubePoint>& tile) {
    std::vector<Eigen::Vector3d> positions;
    std::vector<Rgb> colors;
    for (const CubePoint& point : tile) {
      positions.push_back(grid.position(point.cell));
      colors.push_back(point.color);
    }
    const Glb glb = make_glb(positions, colors);
    folder.write(uri(name), glb.bytes);
    ++figures.tiles;
    return glb.step;
  };
  const std::vector<OctreeTile> roots = build_octree(
      grid, [&](CubePoint& point) { return sorted.next(point); }, write_tile, options.octree);
  folder.write("tileset.json", tileset_json(roots, grid, points.georeference().origin()));
  folder.commit();
  return figures;
}

}  // namespace fovea
