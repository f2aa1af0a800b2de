#include "fovea/merging/tile_fusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "fovea/core/errors.h"
#include "fovea/core/parallel.h"
#include "fovea/core/version.h"
#include "fovea/map/checkpointer.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/tile_cache.h"
#include "fovea/merging/cell_reader.h"
#include "fovea/merging/free_space.h"
#include "fovea/merging/point_merge.h"
#include "fovea/merging/renumbered_column.h"
#include "fovea/merging/tile_output.h"

namespace fovea {
namespace {

constexpr std::int64_t kMostFrames = 1 << 30;
constexpr double kNoPoints = 1;  // size of the tiles of a map that has none, m

/// Reads and fuses one cell.
class TileFusion {
 public:
  TileFusion(const CityPoses& city, const TileFusionJob& job)
      : job_(job), cell_(city, job.tile, job.tile_size) {}

  /// Takes a map's points in the cell.
  void read(const std::filesystem::path& path);
  TileFusionFigures write();

 private:
  void sort_sources();
  void remove_parked(TileFusionFigures& figures);
  MapMeta meta() const;
  /// Puts the points, frames and drives of a source, and opens its submaps.
  void put(std::size_t number, MapWriter& writer, TileMap& map, TileOutput& output);
  void put_frames(const CellSource& source, const std::map<std::size_t, std::size_t>& submaps,
                  MapWriter& writer);

  const TileFusionJob& job_;
  CellReader cell_;
  std::set<std::string> identities_;  // of all maps, also of those without a point in the cell
  std::vector<CellSource> sources_;
  int next_frame_ = 0;
  std::size_t next_sensor_ = 0;
};

void TileFusion::read(const std::filesystem::path& path) {
  CellSource source = cell_.read(path);
  if (!identities_.insert(source.placed->name.identity).second) {
    throw InputError("a map is given twice", path.string(), "give each map once");
  }
  if (source.points == 0) return;
  if (!sources_.empty() && sources_.front().content.tile_size != source.content.tile_size) {
    throw InputError("the tiles of the maps differ in size", path.string(),
                     "map the drives with one map.tile_size_m");
  }
  sources_.push_back(std::move(source));
}

/// The source whose colors count most comes first.
void TileFusion::sort_sources() {
  const auto latest = std::max_element(
      sources_.begin(), sources_.end(),
      [](const CellSource& a, const CellSource& b) { return a.session < b.session; });
  const std::string day = job_.session == "latest" ? latest->session : job_.session;  // or a name
  const auto is_chosen = [&](const CellSource& source) {
    return (!day.empty() && source.session == day) || source.content.drives.front().name == day;
  };
  if (job_.session != "best" && job_.session != "latest" &&
      std::none_of(sources_.begin(), sources_.end(), is_chosen)) {
    throw InputError(fmt::format("no map in tile {} has the session \"{}\"", job_.tile.text(), day),
                     "--session", "give best, latest, a recording day or the name of a drive");
  }
  std::sort(sources_.begin(), sources_.end(), [&](const CellSource& a, const CellSource& b) {
    const auto rank = [&](const CellSource& source) {
      return std::tuple(!is_chosen(source), -double(source.well_seen),
                        source.placed->name.identity);
    };
    return rank(a) < rank(b);
  });
}

/// Leaves out points in space that a later drive saw as free.
void TileFusion::remove_parked(TileFusionFigures& figures) {
  for (const CellSource& later : sources_) {
    std::optional<FreeSpace> free;  // read when it is needed
    for (CellSource& earlier : sources_) {
      if (earlier.session.empty() || !(earlier.session < later.session)) continue;
      if (!free) free.emplace(*later.reader, later.content, later.T_cell_submap, job_.tile_size);
      for (CellPiece& piece : earlier.pieces) {
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
  MapMeta meta;
  if (!sources_.empty()) meta = sources_.front().content.meta;
  meta.erase(meta_key::kFormatVersion);
  meta[meta_key::kFoveaVersion] = version();
  meta[meta_key::kDriveName] = "city tile " + job_.tile.text();
  meta[meta_key::kOriginLatitude] = fmt::format("{}", cell_.middle().latitude);
  meta[meta_key::kOriginLongitude] = fmt::format("{}", cell_.middle().longitude);
  meta[meta_key::kOriginHeight] = fmt::format("{}", cell_.middle().altitude);
  meta[meta_key::kFramesBegin] = "0";
  meta[meta_key::kFramesEnd] = fmt::to_string(next_frame_);
  std::vector<const MapContent*> maps;
  for (const CellSource& source : sources_) {
    maps.push_back(&source.content);
    if (source.content.text(meta_key::kComplete) != "1") meta[meta_key::kComplete] = "0";
    for (const char* key : {meta_key::kCrop, meta_key::kRepair}) {
      if (const std::string text = source.content.text(key); !text.empty()) meta[key] = text;
    }
  }
  meta[meta_key::kCameras] = cameras_of(maps);
  return meta;
}

void TileFusion::put_frames(const CellSource& source,
                            const std::map<std::size_t, std::size_t>& submaps, MapWriter& writer) {
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
    const Eigen::Vector3d& gain = source.placed->submaps[of->first].log2_gain;
    for (ViewRecord& view : frame.views) {
      view.revisit.reset();
      if (view.log2_gain) *view.log2_gain -= gain;  // image = color of the city * 2^gain
      if (view.log2_color) *view.log2_color += gain;
    }
    writer.put_frame(frame);
  }
}

void TileFusion::put(std::size_t number, MapWriter& writer, TileMap& map, TileOutput& output) {
  CellSource& source = sources_[number];
  const int shift = next_frame_ - source.content.drives.front().first_frame;
  std::map<std::size_t, std::size_t> submaps;  // number in the tile by the number in the map
  for (CellPiece& piece : source.pieces) {
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
    renumber(points.frame, [&](std::int32_t frame) { return frame < 0 ? -1 : frame + shift; });
    fill_with_zeros(points.size(), points.session);
    renumber(points.session, [&](std::uint16_t) { return number; });
    fill_with_zeros(points.size(), points.sensor);
    renumber(points.sensor, [&](std::uint16_t sensor) { return sensor + next_sensor_; });
    output.put({place->second, piece.id.key}, std::move(points));
  }
  DriveRecord drive = source.content.records.front();
  drive.source_digest = source.placed->name.identity;
  drive.first_frame = next_frame_;
  drive.frame_shift += shift;
  put_frames(source, submaps, writer);
  drive.end_frame = next_frame_;
  drive.T_local_drive =
      cell_.T_ecef_cell().inverse() * T_ecef_enu(drive.origin.value_or(cell_.middle()));
  writer.put_drive(number, drive);
  for (SensorRecord sensor : source.content.sensors) {
    sensor.drive = static_cast<int>(number);
    writer.put_sensor(next_sensor_++, sensor);
  }
}

TileFusionFigures TileFusion::write() {
  TileFusionFigures figures;
  if (sources_.empty() && !job_.allow_empty) {
    throw InputError(fmt::format("no map has a point in tile {}", job_.tile.text()),
                     job_.output.string(), "give the maps around the tile, or another tile");
  }
  figures.maps = sources_.size();
  std::int64_t frames = 0;
  for (const CellSource& source : sources_) {
    figures.read += source.points;
    const MergedDrive& drive = source.content.drives.front();
    frames += std::int64_t{drive.end_frame} - drive.first_frame;
  }
  if (frames > kMostFrames) {
    throw InputError("the maps have more frames than one can number", job_.output.string(),
                     "fuse smaller tiles, or fewer maps");
  }
  if (!sources_.empty()) sort_sources();
  remove_parked(figures);

  TileMap map(sources_.empty() ? kNoPoints : sources_.front().content.tile_size);
  auto writer = job_.scratch.empty()
                    ? MapWriter::create(job_.output, job_.force)
                    : MapWriter::create_in_scratch(job_.output, job_.force, job_.scratch);
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
