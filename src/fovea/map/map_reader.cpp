#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "fovea/errors.h"
#include "fovea/map/map_file.h"
#include "fovea/map/map_point_filter.h"
#include "fovea/map/map_store.h"
#include "fovea/map/numbered_records.h"
#include "fovea/map/points_in_local.h"
#include "fovea/map/record_rows.h"
#include "fovea/map/submap_rows.h"

namespace fovea {
namespace {

using sqlite::Statement;

/// InputError of a tile that the map should not have so.
[[noreturn]] void fail_at(const TileId& id, const char* what, const std::string& map_path) {
  throw InputError(what,
                   fmt::format("{}, tile {} {} {} of submap {}", map_path, id.key.x, id.key.y,
                               id.key.z, id.submap),
                   kRestoreMap);
}

/// The order of the tiles, which SQLite takes from the file.
class TileOrder {
 public:
  explicit TileOrder(std::string map_path) : map_path_(std::move(map_path)) {}
  void require_after_last(const TileId& id) {
    if (last_ && id <= *last_) fail_at(id, "the tiles are not in order", map_path_);
    last_ = id;
  }

 private:
  std::string map_path_;
  std::optional<TileId> last_;
};

PointCloud passing(std::size_t submap, const PointCloud& tile, const MapPointFilter& where) {
  if (where.empty()) return tile;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < tile.size(); ++i) {
    if (where.matches(submap, tile, i)) indices.push_back(i);
  }
  return tile.select(indices);
}

/// Zero for a submap whose colors have the exposure of the map.
Eigen::Vector3d gain_of(const SubmapRecord& submap) {
  return submap.log2_gain.value_or(Eigen::Vector3d::Zero());
}

void change_exposure(TilePoints& tile, const Eigen::Vector3d& log2_gain) {
  if (log2_gain.isZero(0)) return;
  const Eigen::Array3f codes = (kColorCodesPerStop * log2_gain).cast<float>().array();
  for (FusedColor& color : tile.colors) color.color = with_offset(color.color, codes);
}

/// From gains relative to submaps to gains relative to the map.
void change_exposure(FrameRecord& frame, const std::vector<SubmapRecord>& submaps) {
  const auto gain = [&](int submap) -> Eigen::Vector3d {
    const auto id = static_cast<std::size_t>(submap);
    return submap >= 0 && id < submaps.size() ? gain_of(submaps[id]) : Eigen::Vector3d::Zero();
  };
  for (ViewRecord& view : frame.views) {
    if (view.log2_gain) *view.log2_gain -= gain(frame.submap);
    if (view.log2_color) *view.log2_color += gain(frame.submap);
    if (view.revisit) view.revisit->log2_gain -= gain(view.revisit->submap);
  }
}

}  // namespace

MapReader::MapReader(const std::filesystem::path& path) : MapReader(path, {}) {}
MapReader::MapReader(const std::filesystem::path& path,
                     std::function<void(const std::string&)> on_damage)
    : file_(std::make_unique<MapFile>(path, std::move(on_damage))) {}
MapReader::~MapReader() = default;
MapReader::MapReader(MapReader&&) noexcept = default;

std::shared_ptr<const void> MapReader::hold_state() const {
  return std::make_shared<const Snapshot>(file_->sqlite());
}

int MapReader::format_version() const { return file_->format().version; }

MapMeta MapReader::meta() const { return file_->format().meta(stored_meta(*file_)); }

std::vector<DriveRecord> MapReader::drives() const {
  const Snapshot snapshot(file_->sqlite());
  if (file_->format().drives != nullptr) {
    std::vector<DriveRecord> drives;
    file_->read([&] { drives = file_->format().drives(stored_meta(*file_)); });
    return drives;
  }
  return numbered_records<DriveRecord>(*file_, kDrivesTable, drive_of);
}

std::vector<SensorRecord> MapReader::sensors() const {
  return numbered_records<SensorRecord>(*file_, kSensorsTable, sensor_of);
}

std::vector<FrameRecord> MapReader::frames() const {
  const Snapshot snapshot(file_->sqlite());
  std::vector<FrameRecord> frames = stored_frames();
  std::set<std::size_t> missing;
  const std::vector<SubmapRecord> submaps = read_submaps(*file_, missing);
  for (FrameRecord& frame : frames) change_exposure(frame, submaps);
  return frames;
}

std::vector<FrameRecord> MapReader::stored_frames() const {
  const Snapshot snapshot(file_->sqlite());
  const std::string where = file_->where();
  std::map<int, std::vector<ViewRecord>> views;
  file_->for_each_row(kViewsTable, [&](const Row& row) {
    const auto [frame, view] = view_of(RowCursor(kViewsTable, row, where));
    views[frame].push_back(view);
  });
  std::vector<FrameRecord> frames;
  file_->for_each_row(kFramesTable, [&](const Row& row) {
    FrameRecord frame = frame_of(RowCursor(kFramesTable, row, where));
    // SQLite takes the order from the file. Of a damaged one every whole frame is wanted.
    if (!file_->reports_damage() && !frames.empty() && frame.index <= frames.back().index) {
      throw InputError("the frames are not in order",
                       fmt::format("{}, frame {}", where, frame.index), kRestoreMap);
    }
    if (auto of_frame = views.extract(frame.index)) frame.views = std::move(of_frame.mapped());
    frames.push_back(std::move(frame));
  });
  for (const auto& [frame, of_frame] : views) {
    file_->read([&, number = frame] {
      throw InputError("a view belongs to a frame that is missing",
                       fmt::format("{}, frame {}", where, number), kRestoreMap);
    });
  }
  return frames;
}

std::vector<SubmapRecord> MapReader::submap_records() const {
  const Snapshot snapshot(file_->sqlite());
  std::set<std::size_t> missing;
  std::vector<SubmapRecord> submaps = read_submaps(*file_, missing);
  for (SubmapRecord& submap : submaps) submap.log2_gain.reset();  // the tiles have it
  return submaps;
}

std::vector<RigidMotion> MapReader::submaps() const {
  std::vector<RigidMotion> T_local_submap;
  for (const SubmapRecord& submap : submap_records()) {
    T_local_submap.push_back(submap.T_local_submap);
  }
  return T_local_submap;
}

void MapReader::for_each_keyframe(const std::function<void(const KeyframeRecord&)>& f) const {
  file_->for_each_row(kKeyframesTable, [&](const Row& row) {
    f(keyframe_of(RowCursor(kKeyframesTable, row, file_->where())));
  });
}

std::optional<CheckpointRecord> MapReader::checkpoint(const std::string& name) const {
  const std::optional<Row> row = file_->find_row(kCheckpointTable, name);
  if (!row) return std::nullopt;
  return checkpoint_of(RowCursor(kCheckpointTable, *row, file_->where()));
}

std::size_t MapReader::size() const {
  return static_cast<std::size_t>(file_->query(kTilesTable, [&] {
    return file_->sqlite().integer("SELECT coalesce(sum(points), 0) FROM tiles");
  }));
}

std::size_t MapReader::colored_size() const {
  return static_cast<std::size_t>(file_->query(kTilesTable, [&] {
    return file_->sqlite().integer("SELECT coalesce(sum(colored), 0) FROM tiles");
  }));
}

std::vector<std::pair<TileId, std::size_t>> MapReader::tile_sizes() const {
  const std::string where = file_->where();
  const Snapshot snapshot(file_->sqlite());
  const std::size_t submap_count = submaps().size();
  Statement rows = file_->query(kTilesTable, [&] {
    return Statement(file_->sqlite(),
                     "SELECT submap, x, y, z, points FROM tiles ORDER BY submap, x, y, z");
  });
  std::vector<std::pair<TileId, std::size_t>> sizes;
  TileOrder order(where);
  while (file_->query(kTilesTable, [&] { return rows.step(); })) {
    const std::int64_t submap = rows.integer(0), points = rows.integer(4);
    if (submap < 0 || submap >= static_cast<std::int64_t>(submap_count) || points < 0 ||
        points > kMaxTilePoints) {
      throw InputError("a tile has an impossible submap or size", where, kRestoreMap);
    }
    const TileId id{static_cast<std::size_t>(submap), tile_key(rows, 1, where)};
    order.require_after_last(id);
    sizes.emplace_back(id, static_cast<std::size_t>(points));
  }
  file_->require_count(kTilesTable, static_cast<std::int64_t>(sizes.size()));
  return sizes;
}

Eigen::Vector3d MapReader::submap_gain(std::size_t submap) const {
  const std::optional<Row> row = file_->find_row(kSubmapsTable, fmt::to_string(submap));
  if (!row) return Eigen::Vector3d::Zero();
  return gain_of(submap_of(RowCursor(kSubmapsTable, *row, file_->where())));
}

PointCloud MapReader::read_tile(const TileId& id) const {
  const Snapshot snapshot(file_->sqlite());
  TilePoints tile = file_->tile().read(id, file_->where());
  change_exposure(tile, submap_gain(id.submap));
  return tile.cloud();
}

std::optional<TilePoints> MapReader::find_tile(const TileId& id) const {
  const Snapshot snapshot(file_->sqlite());
  std::optional<TilePoints> tile = file_->tile().find(id, file_->where());
  if (tile) change_exposure(*tile, submap_gain(id.submap));
  return tile;
}

void MapReader::for_each_tile(
    const std::function<void(std::size_t, const TileKey&, const PointCloud&)>& f) const {
  for_each_stored_tile(
      [&](const TileId& id, const TilePoints& tile) { f(id.submap, id.key, tile.cloud()); });
}

void MapReader::for_each_stored_tile(
    const std::function<void(const TileId&, const TilePoints&)>& f) const {
  const Snapshot snapshot(file_->sqlite());
  const std::string where = file_->where();
  std::set<std::size_t> missing;
  const std::vector<SubmapRecord> submaps = read_submaps(*file_, missing);
  TileDecoder decoder(file_->format().tile);
  TileOrder order(where);
  file_->for_each_tile_row([&](const TileRow& row) {
    const bool exists = row.submap >= 0 && row.submap < static_cast<std::int64_t>(submaps.size()) &&
                        !missing.contains(static_cast<std::size_t>(row.submap));
    if (!exists) {
      throw InputError(fmt::format("a tile belongs to submap {}, which is missing", row.submap),
                       where, kRestoreMap);
    }
    const TileId id{static_cast<std::size_t>(row.submap), row.key};
    if (!file_->reports_damage()) order.require_after_last(id);
    TilePoints tile = decoder.decode(row, where);
    change_exposure(tile, gain_of(submaps[id.submap]));
    f(id, tile);
  });
}

PointCloud MapReader::all_points_local(const PointFilter& where) const {
  const Snapshot snapshot(file_->sqlite());
  const std::vector<RigidMotion> T_local_submap = submaps();
  const MapPointFilter filter(*this, where);
  PointCloud points_local;
  for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    const bool joins = points_local.empty() || tile.empty() ||
                       points_local.intensity.empty() == tile.intensity.empty();
    if (!joins) fail_at({submap, key}, "only some tiles have intensities", file_->where());
    points_local.append(points_in_local(passing(submap, tile, filter), T_local_submap[submap]));
  });
  return points_local;
}

void MapReader::check_structure() const { file_->check_structure(); }

void MapReader::check_records() const {
  const Snapshot snapshot(file_->sqlite());
  meta();
  drives();
  sensors();
  frames();
  for_each_keyframe([](const KeyframeRecord&) {});
  file_->for_each_row(kCheckpointTable, [&](const Row& row) {
    checkpoint_of(RowCursor(kCheckpointTable, row, file_->where()));
  });
  file_->for_each_row(kCountsTable, [](const Row&) {});
  submap_records();
}

std::size_t MapReader::check() const {
  const Snapshot snapshot(file_->sqlite());
  check_structure();
  check_records();
  std::size_t tiles = 0;
  for_each_stored_tile([&](const TileId&, const TilePoints&) { ++tiles; });
  return tiles;
}

}  // namespace fovea
