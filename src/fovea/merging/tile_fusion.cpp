#include "fovea/merging/tile_fusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "fovea/errors.h"
#include "fovea/map/camera_models.h"
#include "fovea/map/meta_keys.h"
#include "fovea/merging/cell_reader.h"
#include "fovea/merging/free_space.h"
#include "fovea/merging/known_surfaces.h"
#include "fovea/merging/renumbered_column.h"
#include "fovea/merging/tile_output.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

constexpr std::int64_t kMostFrames = 1 << 30;

/// Leaves the points that `drop` does not name.
/// @return the number of points left out
std::size_t leave_out(const std::vector<bool>& drop, TilePoints& points) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < drop.size(); ++i) {
    if (!drop[i]) kept.push_back(i);
  }
  if (kept.size() < drop.size()) points.keep(kept);
  return drop.size() - kept.size();
}

/// What a drive saw of the space around the cell.
struct LaterFreeSpace {
  std::string session;
  FreeSpace free;
};

/// Fuses one cell, one map after the other: memory grows with the surfaces, not with the maps.
class TileFusion {
 public:
  TileFusion(const CityPoses& city, const TileFusionJob& job)
      : job_(job), cell_(city, job.tile, job.tile_size), known_(job.spacing) {}

  void add_map(const std::filesystem::path& path);
  TileFusionFigures write();

 private:
  void require_points() const;
  void sort_sources();
  void read_free_spaces();
  MapMeta meta() const;
  /// Puts the points, frames and drive of a source, and opens its submaps.
  void put(std::size_t number, MapWriter& writer, TileOutput& output);
  /// Leaves out what is gone and what the tile has already.
  void reduce(const CellSource& source, CellPiece& piece);
  void put_frames(const CellSource& source, const std::map<std::size_t, std::size_t>& submaps,
                  MapWriter& writer);
  void put_drive(std::size_t number, int shift, int first_frame, MapWriter& writer);

  const TileFusionJob& job_;
  CellReader cell_;
  std::set<std::string> identities_;  // of all maps, also of those without a point in the cell
  std::vector<CellSource> sources_, empty_sources_;
  std::vector<LaterFreeSpace> free_spaces_;
  KnownSurfaces known_;
  TileFusionFigures figures_;
  int next_frame_ = 0;
  std::size_t next_submap_ = 0, next_sensor_ = 0;
};

void TileFusion::add_map(const std::filesystem::path& path) {
  CellSource source = cell_.open(path);
  if (!identities_.insert(source.placed->name.identity).second) {
    throw InputError("a map is given twice", path.string(), "give each map once");
  }
  if (source.points == 0) {
    empty_sources_.push_back(std::move(source));
    return;
  }
  if (!sources_.empty() && sources_.front().content.tile_size != source.content.tile_size) {
    throw InputError("the tiles of the maps differ in size", path.string(),
                     "map the drives with one map.tile_size_m");
  }
  figures_.read += source.points;
  sources_.push_back(std::move(source));
}

/// The source whose colors count most comes first.
void TileFusion::sort_sources() {
  if (sources_.empty()) return;
  const auto latest = std::max_element(
      sources_.begin(), sources_.end(),
      [](const CellSource& a, const CellSource& b) { return a.session < b.session; });
  const std::string day = job_.session == "latest" ? latest->session : job_.session;  // or a name
  const auto is_chosen = [&](const CellSource& source) {
    return (!day.empty() && source.session == day) || source.content.drives.front().name == day;
  };
  // A session may have nothing in this tile. Then the best one counts.
  if (job_.session != "best" && job_.session != "latest" &&
      std::none_of(sources_.begin(), sources_.end(), is_chosen) &&
      std::none_of(empty_sources_.begin(), empty_sources_.end(), is_chosen)) {
    throw InputError(fmt::format("no map has the session \"{}\"", day), "--session",
                     "give best, latest, a recording day or the name of a drive");
  }
  std::sort(sources_.begin(), sources_.end(), [&](const CellSource& a, const CellSource& b) {
    const auto rank = [&](const CellSource& source) {
      return std::tuple(!is_chosen(source), -double(source.points_of_two_views),
                        source.placed->name.identity);
    };
    return rank(a) < rank(b);
  });
}

/// A drive of the first day cannot show that an object has left.
void TileFusion::read_free_spaces() {
  std::string first;
  for (const CellSource& source : sources_) {
    if (!source.session.empty() && (first.empty() || source.session < first)) {
      first = source.session;
    }
  }
  for (const std::vector<CellSource>* sources : {&sources_, &empty_sources_}) {
    for (const CellSource& source : *sources) {
      if (first.empty() || source.session <= first) continue;
      FreeSpace free(*source.reader, source.content, source.T_cell_submap, job_.tile_size);
      if (!free.empty()) free_spaces_.push_back({source.session, std::move(free)});
    }
  }
}

void TileFusion::reduce(const CellSource& source, CellPiece& piece) {
  const RigidMotion& T_cell_submap = source.T_cell_submap[piece.id.submap];
  for (const LaterFreeSpace& later : free_spaces_) {
    if (source.session.empty() || later.session <= source.session || piece.points.empty()) continue;
    figures_.parked += leave_out(later.free.contains(piece.points, T_cell_submap), piece.points);
  }
  figures_.known += leave_out(known_.find(piece.points, T_cell_submap), piece.points);
}

MapMeta TileFusion::meta() const {
  MapMeta meta{{meta_key::kComplete, "1"}};  // of a tile without points
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
    copy_camera_models(source.content.meta, 0, maps.size(), meta);
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

void TileFusion::put(std::size_t number, MapWriter& writer, TileOutput& output) {
  const CellSource& source = sources_[number];
  const int first_frame = next_frame_;
  const int shift = first_frame - source.content.drives.front().first_frame;
  std::map<std::size_t, std::size_t> submaps;  // number in the tile by the number in the map
  cell_.for_each_piece(source, [&](CellPiece& piece) {
    // Also for points that other drives show: the frames around them belong to the tile.
    const auto [place, is_new] = submaps.try_emplace(piece.id.submap, next_submap_);
    if (is_new) {
      SubmapRecord record;
      record.T_local_submap = source.T_cell_submap[piece.id.submap];
      record.drive = static_cast<int>(number);
      writer.put_submap(next_submap_++, record);
    }
    reduce(source, piece);
    if (piece.points.empty()) return;
    TilePoints& points = piece.points;
    figures_.points += points.size();
    known_.add(points, source.T_cell_submap[piece.id.submap]);
    renumber(points.frame, [&](std::int32_t frame) { return frame < 0 ? -1 : frame + shift; });
    fill_with_zeros(points.size(), points.session);
    renumber(points.session, [&](std::uint16_t) { return number; });
    fill_with_zeros(points.size(), points.sensor);
    renumber(points.sensor, [&](std::uint16_t sensor) { return sensor + next_sensor_; });
    output.put({place->second, piece.id.key}, std::move(points));
  });
  known_.end_drive();
  put_frames(source, submaps, writer);
  put_drive(number, shift, first_frame, writer);
}

void TileFusion::put_drive(std::size_t number, int shift, int first_frame, MapWriter& writer) {
  const CellSource& source = sources_[number];
  DriveRecord drive = source.content.records.front();
  drive.source_digest = source.placed->name.identity;
  drive.first_frame = first_frame;
  drive.frame_shift += shift;
  drive.end_frame = next_frame_;
  drive.T_local_drive =
      cell_.T_ecef_cell().inverse() * T_ecef_enu(drive.origin.value_or(cell_.middle()));
  writer.put_drive(number, drive);
  for (SensorRecord sensor : source.content.sensors) {
    sensor.drive = static_cast<int>(number);
    writer.put_sensor(next_sensor_++, sensor);
  }
}

void TileFusion::require_points() const {
  if (sources_.empty() && !job_.allow_empty) {
    throw InputError(fmt::format("no map has a point in tile {}", job_.tile.text()),
                     job_.output.string(), "give the maps around the tile, or another tile");
  }
  std::int64_t frames = 0;
  for (const CellSource& source : sources_) {
    const MergedDrive& drive = source.content.drives.front();
    frames += std::int64_t{drive.end_frame} - drive.first_frame;
  }
  if (frames > kMostFrames) {
    throw InputError("the maps have more frames than one can number", job_.output.string(),
                     "fuse smaller tiles, or fewer maps");
  }
}

TileFusionFigures TileFusion::write() {
  require_points();
  sort_sources();
  read_free_spaces();
  const auto writer = MapWriter::create(job_.output, job_.force, job_.scratch);
  TileOutput output(*writer);
  for (std::size_t k = 0; k < sources_.size(); ++k) put(k, *writer, output);
  for (const auto& [key, value] : meta()) writer->put_meta(key, value);
  writer->finish();
  figures_.maps = sources_.size();
  return figures_;
}

}  // namespace

TileFusionFigures fuse_tile(const std::vector<std::filesystem::path>& maps, const CityPoses& city,
                            const TileFusionJob& job) {
  TileFusion fusion(city, job);
  for (const std::filesystem::path& map : maps) fusion.add_map(map);
  return fusion.write();
}

}  // namespace fovea
