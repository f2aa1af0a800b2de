#include "fovea/pipeline/recolor.h"

#include <algorithm>

#include "fovea/core/parallel.h"
#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/occupancy.h"
#include "fovea/map/tile_cache.h"
#include "fovea/mapping/blank_image.h"
#include "fovea/mapping/image_pyramid.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/visible_map.h"

namespace fovea {
namespace {

/// Tiles are looked at this much farther than the region reaches, m: poses round.
constexpr double kMargin = 1;

/// What fusion takes for a point that no view has shown.
void forget_colors(int drive, TilePoints& tile) {
  const auto count = static_cast<std::uint32_t>(tile.size());
  std::fill(tile.colors.begin(), tile.colors.end(), FusedColor{});
  tile.camera = {};
  tile.camera.push_back(kNoCamera, count);
  tile.session = {};
  if (drive > 0) tile.session.push_back(static_cast<std::uint16_t>(drive), count);
}

/// The map without its colours; its tiles are in the file alone.
TileMap copy_uncolored(const MapReader& map, const RecolorJob& job, MapWriter& writer) {
  const auto held_state = map.hold_state();
  TileMap copy(job.settings.tile_size());
  for (const RigidMotion& T_local_submap : copy_all_but_tiles(map, writer)) {
    copy.add_submap(T_local_submap);
  }
  writer.put_meta(meta_key::kConfig, to_toml(job.settings));
  map.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    TilePoints uncolored = tile;
    if (!tile.empty()) forget_colors(job.drive, uncolored);
    writer.put_tile(id, uncolored);
    copy.declare_stored(id, tile.size());
  });
  return copy;
}

/// Within a pixel of the image: positions are rounded. There the image has its color at the border.
bool is_nearly_in_view(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d inside =
      pixel.cwiseMax(0).cwiseMin(Eigen::Vector2d(camera.width - 1, camera.height - 1));
  return (pixel - inside).cwiseAbs().maxCoeff() <= 1;
}

/// Colors the points that a frame added and that recolor() has not reached: points at the border of
/// the region, and points that others have hidden since. Each gets the color of its first view, as
/// when the map was made.
/// @param reach  of the region, with a margin, m
void color_own_points(TileMap& map, const ViewColors& view, const Camera& camera,
                      const DepthBuffer& depth, const RigidMotion& T_local_cam, double reach,
                      int frame) {
  struct OwnPoints {
    TileId tile;
    RigidMotion T_cam_tile;
    LogGain gain;
    std::vector<std::uint32_t> indices;
  };
  std::vector<OwnPoints> all;
  map.for_each_tile_near(
      T_local_cam.translation(), reach, [&](const TileId& id, const TilePoints& tile) {
        const Submap& submap = map.submaps()[id.submap];
        OwnPoints own{
            id,
            T_local_cam.inverse() * submap.T_local_submap * Eigen::Translation3d(tile.origin),
            submap.log2_gain,
            {}};
        tile.frame.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::int32_t of_run) {
          for (std::uint32_t i = begin; of_run == frame && i < end; ++i) {
            if (tile.colors[i].views == 0) own.indices.push_back(i);
          }
        });
        if (!own.indices.empty()) all.push_back(std::move(own));
      });
  for (const OwnPoints& own : all) {
    std::vector<std::uint32_t> colored;
    std::vector<Eigen::Vector3f> points_cam;
    const TilePoints& tile = *map.submaps()[own.tile.submap].tiles.at(own.tile.key).points;
    for (const std::uint32_t i : own.indices) {
      const Eigen::Vector3d p_cam = own.T_cam_tile * tile.position_at(i).cast<double>();
      const auto pixel = camera.project(p_cam);
      const bool is_near = (p_cam - camera.T_cam_lidar.translation()).norm() <= reach;
      if (!is_near || !pixel || !is_nearly_in_view(camera, *pixel)) continue;
      colored.push_back(i);
      points_cam.push_back(p_cam.cast<float>());
    }
    const std::vector<FusedColor> colors = first_colors(points_cam, view, camera, &depth, own.gain);
    const std::span<FusedColor> of_tile = map.colors(own.tile);
    std::vector<std::uint32_t> seen;  // not masked
    for (std::size_t k = 0; k < colored.size(); ++k) {
      if (colors[k].views == 0) continue;
      of_tile[colored[k]] = colors[k];
      seen.push_back(colored[k]);
    }
    map.put_camera(own.tile, seen, static_cast<std::int8_t>(camera.index));
  }
}

class Recolorer {
 public:
  Recolorer(const DriveInfo& drive, const MapSettings& settings, TileMap map, Checkpointer& file,
            std::size_t memory)
      : drive_(drive),
        foveal_(settings.foveal()),
        map_(std::move(map)),
        file_(file),
        cache_(file, memory),
        lidar_origins_(lidar_origins(drive)),
        reach_(foveal_.reach() + farthest_lidar(lidar_origins_) + kMargin) {
    // A map of the paper's method has no spacing: colors are those of patches as by default.
    const MapperOptions options = settings.is_paper() ? MapperOptions() : settings.mapper();
    footprint_ = options.footprint;
    spacing_ = settings.is_paper() ? footprint_
                                   : Occupancy(options.tile_size, options.surface.spacing).cell();
  }

  void see(const Frame& frame, const FrameRecord& record, RecolorFigures& figures) {
    position_local_ = record.T_local_lidar.translation();
    cache_.load_within(map_, position_local_, reach_);
    for (std::size_t slot = 0; slot < frame.images.size(); ++slot) {
      const Image& image = frame.images[slot];
      if (image.empty()) continue;
      const Camera camera = drive_.camera_at(slot, record.index).at_image(record.motion);
      const FovealRegion region(foveal_, camera, lidar_origins_);
      visible_map_.render(map_, region, camera.T_cam_lidar * record.T_local_lidar.inverse(),
                          spacing_);
      const ImagePyramid pyramid(image);
      if (is_blank(image)) {
        ++figures.images_left_out;
      } else {
        // Maps of the paper mapper state no view.
        const ViewRecord* view = record.find_view(camera.index);
        const ViewLight light = view != nullptr ? view->light() : ViewLight();
        const ViewColors colors(pyramid, camera, footprint_, drive_.mask(camera.index));
        visible_map_.find_edges();
        visible_map_.recolor(map_, colors.in_light(light), frame.index);
        color_own_points(map_, colors.in_light(light), camera, visible_map_.depth(),
                         record.T_local_lidar * camera.T_cam_lidar.inverse(), reach_, frame.index);
      }
    }
    if (!cache_.is_full(map_)) return;
    cache_.evict_beyond(map_, position_local_, reach_);
    file_.checkpoint(map_, {});
  }

  void finish() { file_.finish(map_, {}); }

 private:
  const DriveInfo& drive_;
  FovealOptions foveal_;
  TileMap map_;
  Checkpointer& file_;
  TileCache cache_;
  VisibleMap visible_map_;
  std::vector<Eigen::Vector3d> lidar_origins_;
  double reach_, footprint_, spacing_;  // m
  Eigen::Vector3d position_local_ = Eigen::Vector3d::Zero();
};

}  // namespace

RecolorFigures recolor_map(const MapReader& map, const FrameSource& source, const RecolorJob& job,
                           const std::function<void(int, int)>& progress) {
  validate(job.settings);
  require_cameras(source.info(), "recoloring");
  std::vector<FrameRecord> records = map.frames();
  std::erase_if(records, [](const FrameRecord& r) { return r.status != FrameStatus::kMapped; });
  // Before anything is written.
  if (std::none_of(records.begin(), records.end(), [&](const FrameRecord& record) {
        return std::holds_alternative<Frame>(source.load(record.index));
      })) {
    throw InputError("none of the map's frames can be read", source.info().path.string(),
                     "give the drive that the map was made of");
  }
  RecolorFigures figures;
  {
    auto writer = MapWriter::create(job.output, job.force);
    TileMap uncolored = copy_uncolored(map, job, *writer);
    Checkpointer file(std::move(writer),
                      {available_threads() > 1, job.memory, /*commit_at_end=*/true});
    Recolorer recolorer(source.info(), job.settings, std::move(uncolored), file, job.memory);
    for (std::size_t i = 0; i < records.size(); ++i) {
      const LoadedFrame loaded = source.load(records[i].index);
      const auto* frame = std::get_if<Frame>(&loaded);
      if (frame != nullptr) recolorer.see(*frame, records[i], figures);
      ++(frame != nullptr ? figures.frames : figures.unread);
      if (progress) progress(int(i) + 1, int(records.size()));
    }
    recolorer.finish();
  }
  const MapReader recolored(job.output);
  figures.points = recolored.size();
  figures.uncolored = figures.points - recolored.colored_size();
  return figures;
}

}  // namespace fovea
