#include "fovea/server/live_map_server.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/core/path_name.h"

namespace fovea {
namespace {

/// Between two images: as fast as a sensor of 10 Hz takes them.
constexpr std::int64_t kImagePause = 90;  // ms

std::int64_t now_ms() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since_1970).count();
}

MapDescription describe_run(const DriveInfo& drive, const MapJob& job) {
  MapDescription map;
  map.name = name_of(drive.path);
  map.live = true;
  map.images = true;
  map.origin = drive.origin;
  map.tile_size = job.settings.tile_size();
  map.sensor_period = drive.sweep.period;
  map.cameras = drive.calibration.cameras;
  if (job.settings.has_foveal_region()) {
    map.foveal =
        MapDescription::Foveal{job.settings.foveal().near_range, job.settings.foveal().far_range};
  }
  return map;
}

/// What the page is told of a frame's record.
FrameRecord told(const FrameRecord& record) {
  FrameRecord told;
  told.index = record.index;
  told.stamp = record.stamp;
  told.status = record.status;
  told.T_local_lidar = record.T_local_lidar;
  told.milliseconds = record.milliseconds;
  const auto score = record.figures.find(kScoreFigure);
  if (score != record.figures.end()) told.figures.insert(*score);
  return told;
}

/// 0: the drive has no known end.
int frames_of(const DriveInfo& drive) {
  return drive.kind == kLiveDrive ? 0 : static_cast<int>(drive.frame_count());
}

}  // namespace

LiveMapServer::LiveMapServer(const MapJob& job, std::shared_ptr<FrameImages> images,
                             std::span<const PageFile> page, const WebServerOptions& options)
    : job_(job),
      images_(std::move(images)),
      page_(page),
      description_(describe_run(images_->info(), job)),
      session_(job.output, job.resume, job.settings.tile_size(), frames_of(images_->info())),
      server_(options,
              [this](const std::string& path, WebServer::Reply reply) {
                answer(path, std::move(reply));
              },
              {{"live", [this] { return session_.make_feed(); }}}) {
  if (!job.resume) return;
  const MapReader map(job.output);
  std::vector<FrameRecord> frames;
  for (const FrameRecord& record : map.frames()) frames.push_back(told(record));
  session_.resume_from(frames, map.size());
}

LiveMapServer::~LiveMapServer() {
  server_.stop();
  site_.reset();  // with it the replies that it keeps for later
}

void LiveMapServer::frame_mapped(const FrameRecord& record, const Frame* frame,
                                 const TileMap& map) {
  ShownFrame live;
  live.record = told(record);
  live.points = map.size();
  live.late = is_late(record, job_.rate);
  late_frames_ += live.late;
  live.late_frames = late_frames_;
  live.mapped_at = now_ms();
  std::vector<RigidMotion> T_local_submap;
  for (const Submap& submap : map.submaps()) T_local_submap.push_back(submap.T_local_submap);
  const bool watched = session_.has_clients();
  if (!watched) samples_.clear();
  session_.add_frame(std::move(live), T_local_submap,
                     watched ? new_points(record.index, map) : nullptr,
                     watched ? next_image(frame) : nullptr);
  if (frame != nullptr) images_->add(*frame);
  server_.wake();
}

/// The first camera's image that there is, unless the last one was shown just now.
std::shared_ptr<ShownImage> LiveMapServer::next_image(const Frame* frame) {
  if (frame == nullptr || now_ms() - image_at_ < kImagePause) return nullptr;
  for (std::size_t i = 0; i < frame->images.size(); ++i) {
    if (frame->images[i].empty()) continue;
    image_at_ = now_ms();
    return std::make_shared<ShownImage>(frame->index, description_.cameras.at(i).index,
                                        frame->images[i]);
  }
  return nullptr;
}

std::shared_ptr<const std::string> LiveMapServer::new_points(int frame, const TileMap& map) {
  if (map.submaps().empty()) return nullptr;
  const std::size_t submap = map.submaps().size() - 1;
  std::string sections;
  std::size_t count = 0;
  for (const auto& [key, tile] : map.submaps().back().tiles) {
    const TilePoints& points = *tile.points;
    if (points.empty() || points.frame.back() != frame) continue;
    const TileId id{submap, key};
    std::vector<std::uint32_t> fresh;  // of a tile that was not looked at before, not the others
    for (const std::uint32_t i : samples_[id].more(points, map.tile_size())) {
      if (points.frame[i] == frame) fresh.push_back(i);
    }
    if (fresh.empty()) continue;
    append_section(sections, id, &points, fresh, /*whole=*/false);
    ++count;
  }
  return std::make_shared<const std::string>(points_header(frame, count) + sections);
}

void LiveMapServer::map_changed(const TileChanges& changes, const MapRows& rows,
                                const TileMap& map) {
  session_.move_frames(rows.poses);
  std::set<TileId> changing;
  for (const TileChanges::Changed& tile : changes.changed) changing.insert(tile.id);
  std::vector<TileId> settled = changes.removed;
  for (const TileId& id : changing_) {
    if (!changing.contains(id)) settled.push_back(id);
  }
  std::map<TileId, LiveSession::Bytes> sections;
  if (session_.has_clients()) {
    for (const TileId& id : settled) {
      if (auto section = whole_section(id, map)) sections[id] = std::move(section);
    }
  }
  std::vector<TileId> written(changing.begin(), changing.end());
  written.insert(written.end(), changes.removed.begin(), changes.removed.end());
  std::erase_if(samples_, [&](const auto& sample) { return !changing.contains(sample.first); });
  session_.checkpoint(std::move(written), settled, std::move(sections));
  changing_ = std::move(changing);
  server_.wake();
}

/// nullptr if the tile is in the file alone.
LiveSession::Bytes LiveMapServer::whole_section(const TileId& id, const TileMap& map) {
  std::string section;
  const Submap& submap = map.submaps().at(id.submap);
  const auto tile = submap.tiles.find(id.key);
  if (tile != submap.tiles.end()) {
    const TilePoints& points = *tile->second.points;
    LiveSample& sample = samples_[id];
    sample.more(points, map.tile_size());
    append_section(section, id, &points, sample.all(), /*whole=*/true);
  } else if (!submap.stored.contains(id.key)) {
    append_section(section, id, nullptr, {}, /*whole=*/true);
  } else {
    return nullptr;
  }
  return std::make_shared<const std::string>(std::move(section));
}

void LiveMapServer::finish() {
  auto site =
      std::make_shared<MapSite>(make_map_content(job_.output, images_.get()), page_, images_);
  {
    const std::lock_guard lock(guard_);
    site_ = std::move(site);
  }
  session_.end();
  server_.wake();
}

std::string LiveMapServer::live_json() const {
  MapDescription now = description_;
  now.points = session_.points();
  now.colored_points = now.points;
  return to_json(now);
}

void LiveMapServer::answer(const std::string& path, WebServer::Reply reply) {
  std::shared_ptr<MapSite> site;
  {
    const std::lock_guard lock(guard_);
    site = site_;
  }
  if (site) return site->answer(path, std::move(reply));
  const auto json = [&](std::string text) {
    reply({200, media_type(".json"), std::make_shared<const std::string>(std::move(text))});
  };
  if (path == "map.json") return json(live_json());
  if (path == "frames.json") return json(session_.frames_json());
  if (path == "status.json") return json(nlohmann::json{{"state", "live"}}.dump());
  if (FrameImages::has(path)) return reply(images_->response(path));
  reply(page_response(page_, path));
}

}  // namespace fovea
