#include "fovea/merging/cell_reader.h"

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/map/tile_place.h"

namespace fovea {
namespace {

constexpr std::uint8_t kGoodViews = 2;  // images that make a color good

}  // namespace

CellReader::CellReader(const CityPoses& city, const CityTile& tile, double tile_size)
    : city_(city),
      tile_(tile),
      grid_(city.origin, tile_size),
      middle_(grid_.middle(tile)),
      T_ecef_cell_(T_ecef_enu(middle_)) {}

CellSource CellReader::open(const std::filesystem::path& path) const {
  CellSource source;
  source.reader = std::make_unique<MapReader>(path);
  source.content = MapContent(*source.reader);
  require_one_drive(source.content, path.string());
  const std::string& identity = source.content.drives.front().digest;
  for (const PlacedMap& placed : city_.maps) {
    if (placed.name.identity == identity) source.placed = &placed;
  }
  if (source.placed == nullptr ||
      source.placed->submaps.size() != source.content.T_local_submap.size()) {
    throw InputError("the poses are of other maps", path.string(),
                     "adjust this map, too, or give the poses that were made of it");
  }
  source.session = source.content.records.front().session.value_or("");
  for (const SubmapPlacement& submap : source.placed->submaps) {
    source.T_cell_submap.push_back(T_ecef_cell_.inverse() * submap.T_ecef_submap);
  }
  for_each_piece(source, [&](const CellPiece& piece) {
    source.points += piece.points.size();
    for (const FusedColor& color : piece.points.colors) {
      source.points_of_two_views += color.views >= kGoodViews;
    }
  });
  return source;
}

void CellReader::for_each_piece(const CellSource& source,
                                const std::function<void(CellPiece&)>& f) const {
  for (const auto& [id, points] : source.reader->tile_sizes()) {
    CellPiece piece = piece_of(id, source);
    if (!piece.points.empty()) f(piece);
  }
}

std::optional<CityTile> CellReader::tile_of_box(const RigidMotion& T_ecef_submap,
                                                const Eigen::Vector3d& middle, double size) const {
  constexpr double kMargin = 0.01;  // m, far more than a grid line bends within a box
  std::optional<CityTile> tile;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sides((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                (corner & 4) != 0 ? 1 : -1);
    const CityTile of_corner =
        grid_.tile_at(T_ecef_submap * (middle + (size / 2 + kMargin) * sides));
    if (tile && of_corner != *tile) return std::nullopt;
    tile = of_corner;
  }
  return tile;
}

void CellReader::keep_inside(const RigidMotion& T_ecef_submap, TilePoints& points) const {
  std::vector<char> inside(points.size());
  parallel_chunks(inside.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p_submap = points.origin + points.position_at(i).cast<double>();
      inside[i] = grid_.tile_at(T_ecef_submap * p_submap) == tile_;
    }
  });
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < inside.size(); ++i) {
    if (inside[i]) kept.push_back(i);
  }
  if (kept.size() < inside.size()) points.keep(kept);
}

CellPiece CellReader::piece_of(const TileId& id, const CellSource& source) const {
  const double size = source.content.tile_size;
  const RigidMotion& T_cell_submap = source.T_cell_submap.at(id.submap);
  const Eigen::Vector3d middle_cell = T_cell_submap * middle_of(id.key, size);
  // Far from the origin, cells are turned against east and north.
  const double reach = reach_of_tile(size) + 0.75 * grid_.size();
  if (!(middle_cell.head<2>().cwiseAbs().maxCoeff() <= reach)) return {id, {}};
  const RigidMotion T_ecef_submap = T_ecef_cell_ * T_cell_submap;
  const std::optional<CityTile> of_all = tile_of_box(T_ecef_submap, middle_of(id.key, size), size);
  if (of_all && *of_all != tile_) return {id, {}};
  auto tile = source.reader->find_tile(id);
  if (!tile) return {id, {}};
  if (!of_all) keep_inside(T_ecef_submap, *tile);
  const Eigen::Array3f codes =
      source.placed->submaps[id.submap].log2_gain.cast<float>().array() * float(kColorCodesPerStop);
  for (FusedColor& color : tile->colors) color.color = with_offset(color.color, codes);
  return {id, *std::move(tile)};
}

}  // namespace fovea
