#include "fovea/exporting/orthophoto/orthophoto_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "fovea/core/output_file.h"
#include "fovea/drive/writers/png_stream.h"
#include "fovea/errors.h"
#include "fovea/exporting/orthophoto/pixel_grid.h"
#include "fovea/exporting/orthophoto/top_view.h"
#include "fovea/map/map_meta.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr int kStripePixels = 1 << 22;  // 84 MB of TopView

struct TileBounds {
  TileId id;
  Eigen::AlignedBox2d in_plan;
};

/// The chosen points of a map, tile by tile, as often as needed.
class ChosenTiles {
 public:
  ChosenTiles(const MapReader& map, const PointChoice& choice) : points_(map, choice) {
    std::size_t streamed = 0;
    for (const auto& [id, count] : map.tile_sizes()) {
      const std::vector<ExportPoint>& tile = read(id);
      streamed += tile.size();
      Eigen::AlignedBox2d in_plan;
      for (const ExportPoint& point : tile) in_plan.extend(point.position.head<2>());
      if (!tile.empty()) tiles_.push_back({id, in_plan});
      bounds_.extend(in_plan);
    }
    points_.require_all(streamed);
  }
  const PointStream& points() const { return points_; }
  const Eigen::AlignedBox2d& bounds() const { return bounds_; }
  /// Valid until the next call.
  const std::vector<ExportPoint>& read(const TileId& id) {
    tile_.clear();
    points_.append_tile(id, tile_);
    return tile_;
  }
  const std::vector<TileBounds>& tiles() const { return tiles_; }

 private:
  PointStream points_;
  std::vector<TileBounds> tiles_;
  Eigen::AlignedBox2d bounds_;
  std::vector<ExportPoint> tile_;
};

/// Rows [begin, end) of the picture and kWidestGap rows above and below, which fill their gaps.
TopView view_of(ChosenTiles& chosen, const PixelGrid& grid, int begin, int end) {
  TopView view(grid.width(), end - begin);
  for (const TileBounds& tile : chosen.tiles()) {
    const int first = grid.row(tile.in_plan.max().y()), last = grid.row(tile.in_plan.min().y());
    if (last < begin || first >= end) continue;
    for (const ExportPoint& point : chosen.read(tile.id)) {
      const int row = grid.row(point.position.y());
      if (row < begin || row >= end) continue;
      view.add(grid.column(point.position.x()), row - begin, point.position.z(), point.color);
    }
  }
  return view;
}

std::size_t write_picture(ChosenTiles& chosen, const PixelGrid& grid, std::ostream& stream) {
  PngStream png(stream, grid.width(), grid.height());
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(grid.width()));
  const int stripe = std::max(1, kStripePixels / grid.width());
  std::size_t filled = 0;
  for (int begin = 0; begin < grid.height(); begin += stripe) {
    const int end = std::min(begin + stripe, grid.height());
    const int top = std::max(0, begin - TopView::kWidestGap);
    const int bottom = std::min(end + TopView::kWidestGap, grid.height());
    const TopView view = view_of(chosen, grid, top, bottom);
    for (int row = begin; row < end; ++row) {
      filled += view.render_row(row - top, rgba);
      png.put_row(rgba);
    }
  }
  png.finish();
  return filled;
}

/// The CRS as GDAL, QGIS and ArcGIS read it.
std::string auxiliary_file(const Georeference& georeference) {
  std::string text = "<PAMDataset>\n  <SRS dataAxisToSRSAxisMapping=\"1,2\">";
  for (const char c : georeference.wkt1_in_plan()) {
    c == '"' ? text += "&quot;" : text += c;
  }
  return text + "</SRS>\n</PAMDataset>\n";
}

void check_options(const fs::path& path, const OrthophotoOptions& options) {
  if (path.extension() != ".png") {
    throw ConfigError("an orthophoto is a PNG file", path.string(),
                      "give a name that ends in .png");
  }
  if (options.points.crs == Crs::kEcef) {
    throw ConfigError("an orthophoto needs coordinates in plan", "--crs", "choose utm or local");
  }
  if (!(options.pixel > 0) || !std::isfinite(options.pixel)) {
    throw ConfigError("the edge of a pixel is not above 0", "--pixel", "give meters, such as 0.05");
  }
}

}  // namespace

Crs orthophoto_crs(const MapReader& map) {
  return map_origin(map.meta()) ? Crs::kUtm : Crs::kLocal;
}

std::array<fs::path, 3> orthophoto_files(const fs::path& path) {
  fs::path world_file = path, auxiliary = path;
  world_file.replace_extension(".pgw");
  auxiliary += ".aux.xml";
  return {path, world_file, auxiliary};
}

OrthophotoFigures write_orthophoto(const MapReader& map, const fs::path& path,
                                   const OrthophotoOptions& options) {
  check_options(path, options);
  const auto [picture_path, world_path, auxiliary_path] = orthophoto_files(path);
  OutputFile picture(picture_path, options.force), world(world_path, options.force);
  OutputFile auxiliary(auxiliary_path, options.force);
  ChosenTiles chosen(map, options.points);
  if (chosen.tiles().empty() && options.may_be_empty) return {chosen.points().figures()};
  if (chosen.tiles().empty()) {
    throw InputError("no point of the map is chosen", path.string(),
                     "choose other conditions with --where, or give --uncolored");
  }
  const PixelGrid grid(chosen.bounds(), options.pixel);
  OrthophotoFigures figures{chosen.points().figures(), grid.width(), grid.height()};
  figures.filled_pixels = write_picture(chosen, grid, picture.stream());
  world.stream() << grid.world_file();
  auxiliary.stream() << auxiliary_file(chosen.points().georeference());
  picture.stream().flush();  // a full disk shows here, before any file appears
  auxiliary.commit();
  world.commit();
  picture.commit();
  return figures;
}

}  // namespace fovea
