#include "fovea/merging/cell_reader.h"

#include "fovea/core/errors.h"
#include "fovea/core/parallel.h"
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

CellSource CellReader::read(const std::filesystem::path& path) const {
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
  for (const auto& [id, points] : source.reader->tile_sizes()) take(id, source);
  return source;
}

void CellReader::take(const TileId& id, CellSource& source) const {
  const double size = source.content.tile_size;
  const RigidMotion& T_cell_submap = source.T_cell_submap.at(id.submap);
  const Eigen::Vector3d middle_cell = T_cell_submap * middle_of(id.key, size);
  // Far from the origin, cells are turned against east and north.
  const double reach = reach_of_tile(size) + 0.75 * grid_.size();
  if (!(middle_cell.head<2>().cwiseAbs().maxCoeff() <= reach)) return;
  auto tile = source.reader->find_tile(id);
  if (!tile) return;
  std::vector<char> inside(tile->size());
  parallel_chunks(inside.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p_cell =
          T_cell_submap * (tile->origin + tile->position_at(i).cast<double>());
      inside[i] = grid_.tile_at(T_ecef_cell_ * p_cell) == tile_;
    }
  });
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < inside.size(); ++i) {
    if (inside[i]) kept.push_back(i);
  }
  if (kept.empty()) return;
  if (kept.size() < inside.size()) tile->keep(kept);
  const Eigen::Array3f codes =
      source.placed->submaps[id.submap].log2_gain.cast<float>().array() * float(kColorCodesPerStop);
  for (FusedColor& color : tile->colors) {
    source.well_seen += color.views >= kGoodViews;
    color.color = with_offset(color.color, codes);
  }
  source.points += tile->size();
  source.pieces.push_back({id, *std::move(tile)});
}

}  // namespace fovea
