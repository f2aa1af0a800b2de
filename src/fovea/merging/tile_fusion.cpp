#include "fovea/merging/tile_fusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "fovea/core/errors.h"
#include "fovea/core/parallel.h"
#include "fovea/core/version.h"
#include "fovea/map/checkpointer.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/tile_cache.h"
#include "fovea/map/tile_place.h"
#include "fovea/merging/free_space.h"
#include "fovea/merging/map_content.h"
#include "fovea/merging/point_merge.h"
#include "fovea/merging/tile_output.h"

namespace fovea {
namespace {

constexpr std::uint8_t kGoodViews = 2;  // images that make a color good

/// The points of a map's tile that lie in the cell.
struct Piece {
  TileId id;
  TilePoints points;
};

/// A map, and what it has in the cell.
struct Source {
  std::unique_ptr<MapReader> reader;
  MapContent content;
  const PlacedMap* placed = nullptr;
  std::string session;  // recording day
  std::vector<RigidMotion> T_cell_submap;
  std::vector<Piece> pieces;
  std::size_t points = 0, good = 0;  // in the cell, and those with a good color
};

/// Reads and fuses one cell.
class TileFusion {
 public:
  TileFusion(const CityPoses& city, const TileFusionJob& job)
      : city_(city),
        job_(job),
        grid_(city.origin, job.tile_size),
        middle_(grid_.middle(job.tile)),
        T_ecef_cell_(T_ecef_enu(middle_)) {}

  /// Takes a map's points in the cell.
  void read(const std::filesystem::path& path);
  TileFusionFigures write();

 private:
  bool is_inside(const Eigen::Vector3d& p_cell) const {
    return grid_.tile_at(T_ecef_cell_ * p_cell) == job_.tile;
  }
  /// Takes the points of a tile that lie in the cell.
  void take(const TileId& id, Source& source) const;
  void sort_sources();
  void remove_parked(TileFusionFigures& figures);
  MapMeta meta() const;
  /// Puts the points, frames and drives of a source, and opens its submaps.
  void put(std::size_t number, MapWriter& writer, TileMap& map, TileOutput& output);
  void put_frames(const Source& source, const std::map<std::size_t, std::size_t>& submaps,
                  MapWriter& writer);

  const CityPoses& city_;
  const TileFusionJob& job_;
  CityGrid grid_;
  GeodeticPoint middle_;
  RigidMotion T_ecef_cell_;
  std::vector<Source> sources_;
  int next_frame_ = 0;
  std::size_t next_sensor_ = 0;
};

void TileFusion::read(const std::filesystem::path& path) {
  Source source;
  source.reader = std::make_unique<MapReader>(path);
  source.content = MapContent(*source.reader);
  const std::string digest = source.reader->digest();
  for (const PlacedMap& placed : city_.maps) {
    if (placed.name.digest == digest) source.placed = &placed;
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
  if (source.points > 0) sources_.push_back(std::move(source));
}

void TileFusion::take(const TileId& id, Source& source) const {
  const double size = source.content.tile_size;
  const RigidMotion& T_cell_submap = source.T_cell_submap.at(id.submap);
  const Eigen::Vector3d middle_cell = T_cell_submap * middle_of(id.key, size);
  const double reach = reach_of_tile(size) + grid_.size() * 0.51;  // cells differ a little in size
  if (middle_cell.head<2>().cwiseAbs().maxCoeff() > reach) return;
  auto tile = source.reader->find_tile(id);
  if (!tile) return;
  std::vector<char> inside(tile->size());
  parallel_chunks(inside.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      inside[i] = is_inside(T_cell_submap * (tile->origin + tile->position_at(i).cast<double>()));
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
    source.good += color.views >= kGoodViews;
    color.color = with_offset(color.color, codes);
  }
  source.points += tile->size();
  source.pieces.push_back({id, *std::move(tile)});
}

/// The source whose colors count most comes first.
void TileFusion::sort_sources() {
  const auto latest =
      std::max_element(sources_.begin(), sources_.end(),
                       [](const Source& a, const Source& b) { return a.session < b.session; });
  const std::string day = job_.session == "latest" ? latest->session : job_.session;
  const auto is_chosen = [&](const Source& source) {
    return source.session == day || source.content.drives.front().name == day;
  };
  if (job_.session != "best" && job_.session != "latest" &&
      std::none_of(sources_.begin(), sources_.end(), is_chosen)) {
    throw InputError(fmt::format("no map in tile {} has the session \"{}\"", job_.tile.text(), day),
                     "--session", "give best, latest, a recording day or the name of a drive");
  }
  std::sort(sources_.begin(), sources_.end(), [&](const Source& a, const Source& b) {
    const auto rank = [&](const Source& source) {
      return std::tuple(!is_chosen(source), -double(source.good), source.placed->name.digest);
    };
    return rank(a) < rank(b);
  });
}

/// Leaves out points in space that a later drive saw as free.
void TileFusion::remove_parked(TileFusionFigures& figures) {
  for (const Source& later : sources_) {
    std::optional<FreeSpace> free;  // read when it is needed
    for (Source& earlier : sources_) {
      if (!(earlier.session < later.session)) continue;
      if (!free) free.emplace(*later.reader, later.content, later.T_cell_submap, grid_.size());
      for (Piece& piece : earlier.pieces) {
        const std::vector<bool> gone =
            free->contains(piece.points, earlier.T_cell_submap[piece.id.submap]);
        std::vector<std::uint32_t> kept;
        for (std::uint32_t i = 0; i < gone.size(); ++i) {
          if (!gone[i]) kept.push_back(i);
        }
        figures.parked += gone.size() - kept.size();
        if (kept.size() < gone.size()) piece.points.keep(kept);
      }
    }
  }
}

MapMeta TileFusion::meta() const {
  MapMeta meta = sources_.front().content.meta;
  meta.erase(meta_key::kFormatVersion);
  meta[meta_key::kFoveaVersion] = version();
  meta[meta_key::kDriveName] = "city tile " + job_.tile.text();
  meta[meta_key::kOriginLatitude] = fmt::format("{}", middle_.latitude);
  meta[meta_key::kOriginLongitude] = fmt::format("{}", middle_.longitude);
  meta[meta_key::kOriginHeight] = fmt::format("{}", middle_.altitude);
  meta[meta_key::kFramesBegin] = "0";
  meta[meta_key::kFramesEnd] = fmt::to_string(next_frame_);
  std::vector<const MapContent*> maps;
  for (const Source& source : sources_) maps.push_back(&source.content);
  meta[meta_key::kCameras] = cameras_of(maps);
  return meta;
}

void TileFusion::put_frames(const Source& source, const std::map<std::size_t, std::size_t>& submaps,
                            MapWriter& writer) {
  const int shift = next_frame_ - source.content.drives.front().first_frame;
  for (FrameRecord frame : source.content.frames) {
    const auto of = frame.submap < 0 ? submaps.end() : submaps.find(std::size_t(frame.submap));
    frame.index += shift;
    next_frame_ = std::max(next_frame_, frame.index + 1);
    if (of == submaps.end()) continue;  // it has nothing in the cell
    const RigidMotion T_cell_local =
        source.T_cell_submap[of->first] * source.content.T_local_submap[of->first].inverse();
    frame.T_local_lidar = T_cell_local * frame.T_local_lidar;
    frame.T_local_lidar_navigation.reset();  // it was in the frame of the drive's own map
    frame.revisit.reset();
    frame.submap = static_cast<int>(of->second);
    for (ViewRecord& view : frame.views) view.revisit.reset();
    writer.put_frame(frame);
  }
}

void TileFusion::put(std::size_t number, MapWriter& writer, TileMap& map, TileOutput& output) {
  Source& source = sources_[number];
  const int shift = next_frame_ - source.content.drives.front().first_frame;
  std::map<std::size_t, std::size_t> submaps;  // number in the tile by the number in the map
  for (Piece& piece : source.pieces) {
    if (piece.points.empty()) continue;
    const auto [place, is_new] = submaps.try_emplace(piece.id.submap, map.submaps().size());
    if (is_new) {
      SubmapRecord record;
      record.T_local_submap = source.T_cell_submap[piece.id.submap];
      record.drive = static_cast<int>(number);
      writer.put_submap(place->second, record);
      map.add_submap(record.T_local_submap);
    }
    TilePoints& points = piece.points;
    RunColumn<std::int32_t> frames;
    points.frame.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::int32_t frame) {
      frames.push_back(frame + shift, end - begin);
    });
    points.frame = std::move(frames);
    points.session = {};
    points.session.push_back(static_cast<std::uint16_t>(number),
                             static_cast<std::uint32_t>(points.size()));
    points.sensor = {};
    points.sensor.push_back(static_cast<std::uint16_t>(next_sensor_),
                            static_cast<std::uint32_t>(points.size()));
    output.put({place->second, piece.id.key}, std::move(points));
  }
  DriveRecord drive = source.content.records.front();
  drive.source_digest = source.placed->name.digest;
  drive.first_frame = next_frame_;
  drive.frame_shift += shift;
  put_frames(source, submaps, writer);
  drive.end_frame = next_frame_;
  drive.T_local_drive = T_ecef_cell_.inverse() * T_ecef_enu(drive.origin.value_or(middle_));
  writer.put_drive(number, drive);
  for (SensorRecord sensor : source.content.sensors) {
    sensor.drive = static_cast<int>(number);
    writer.put_sensor(next_sensor_++, sensor);
  }
}

TileFusionFigures TileFusion::write() {
  TileFusionFigures figures;
  if (sources_.empty()) {
    throw InputError(fmt::format("no map has a point in tile {}", job_.tile.text()),
                     job_.output.string(), "give the maps around the tile, or another tile");
  }
  figures.maps = sources_.size();
  for (const Source& source : sources_) figures.read += source.points;
  sort_sources();
  remove_parked(figures);

  TileMap map(sources_.front().content.tile_size);
  auto writer = MapWriter::create(job_.output, job_.force);
  TileOutput output(*writer, map);
  std::vector<std::size_t> first_submap;
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    first_submap.push_back(map.submaps().size());
    put(k, *writer, map, output);
    sources_[k].pieces.clear();
  }
  for (const auto& [key, value] : meta()) writer->put_meta(key, value);
  Checkpointer file(std::move(writer),
                    {available_threads() > 1, job_.memory, /*commit_at_end=*/true});
  TileCache cache(file, job_.memory);
  for (const std::size_t first : first_submap) {
    if (first == 0) continue;
    figures.known += merge_points(map, first, job_.spacing, KnownColors::kDrop, file, cache).known;
  }
  file.finish(map, {});
  figures.points = map.size();
  return figures;
}

}  // namespace

TileFusionFigures fuse_tile(const std::vector<std::filesystem::path>& maps, const CityPoses& city,
                            const TileFusionJob& job) {
  TileFusion fusion(city, job);
  for (const std::filesystem::path& map : maps) fusion.read(map);
  return fusion.write();
}

}  // namespace fovea
