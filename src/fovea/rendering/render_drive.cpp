#include "fovea/rendering/render_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/drive/writers/generic_drive_writer.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/rendering/splat.h"

namespace fovea {
namespace {

/// What splats are drawn of.
struct ColouredSurfels {
  ColoredPoints points;
  std::vector<float> spacing;
};

ColouredSurfels coloured(const MapSurfels& map) {
  constexpr std::size_t kRunLength = 1024;
  ColouredSurfels result;
  result.points.origin = map.origin;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.colored[i] == 0) continue;
    result.points.position.push_back(map.position[i]);
    result.points.color.push_back(map.color[i]);
    result.spacing.push_back(map.spacing[i]);
  }
  result.points.runs = make_runs(result.points.position, kRunLength);
  return result;
}

std::vector<std::uint8_t> depth_png(const SplatView& view) {
  std::vector<std::uint16_t> depth(view.depth.size(), 0);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const float scaled = view.depth[i] * 256;
    if (scaled < 65535.5f) depth[i] = static_cast<std::uint16_t>(std::lround(scaled));
  }
  return encode_png_16(view.image.width, view.image.height, depth);
}

class DriveRenderer {
 public:
  DriveRenderer(const MapReader& map, const RenderJob& job)
      : job_(job),
        display_(color_display(job.exposure, map.frames())),
        window_(map, job.reach),
        writer_(job.output, job.force) {
    if (job.lidar) {
      lidar_ = *job.lidar;
      lidar_.max_range = std::min(lidar_.max_range, job.reach);
    }
  }

  void render(int frame) {
    const RigidMotion& T_local_lidar = job_.T_local_lidar[std::size_t(frame)];
    const MapSurfels& surfels = window_.around(T_local_lidar.translation());
    if (!job_.cameras.empty() && drawn_version_ != window_.version()) {
      coloured_ = coloured(surfels);
      drawn_version_ = window_.version();
    }
    for (const RenderedCamera& camera : job_.cameras) draw(camera, T_local_lidar, frame);
    if (job_.lidar) scan(surfels, T_local_lidar, frame);
    ++figures_.frames;
  }

  RenderFigures finish() {
    RecordedDrive drive;
    drive.lidar.sweep_compensated = true;  // all beams at once
    for (const RenderedCamera& rendered : job_.cameras) {
      const Camera& c = rendered.camera;
      RecordedCamera recorded;
      recorded.name = rendered.name;
      recorded.index = c.index;
      recorded.optics.width = c.width, recorded.optics.height = c.height;
      recorded.optics.fx = c.fx, recorded.optics.fy = c.fy;
      recorded.optics.cx = c.cx, recorded.optics.cy = c.cy;
      recorded.T_lidar_cam = c.T_cam_lidar.inverse();
      drive.cameras.push_back(std::move(recorded));
    }
    for (std::size_t i = 0; i < job_.T_local_lidar.size(); ++i) {
      drive.poses.push_back({stamp(int(i)), job_.T_local_lidar[i]});
    }
    writer_.finish(drive);
    const double images = double(figures_.frames * job_.cameras.size());
    if (images > 0) figures_.covered /= images;
    if (figures_.frames > 0) figures_.points /= double(figures_.frames);
    return figures_;
  }

 private:
  TimeNs stamp(int frame) const { return frame * job_.period; }

  void draw(const RenderedCamera& rendered, const RigidMotion& T_local_lidar, int frame) {
    SplatOptions options;
    options.max_radius = 40;  // what is near fills the image, too
    options.max_depth = job_.reach;
    options.display = display_;
    const Camera& camera = rendered.camera;
    const SplatView view = splat(coloured_.points, coloured_.spacing, camera,
                                 camera.T_cam_lidar * T_local_lidar.inverse(), options);
    const auto drawn = std::count(view.covered.begin(), view.covered.end(), 1);
    figures_.covered += double(drawn) / double(view.covered.size());
    figures_.blank += drawn == 0;
    writer_.write_image(rendered.name, frame, stamp(frame), view.image);
    const std::vector<std::uint8_t> png = depth_png(view);
    writer_.write_file(
        std::filesystem::path("depth") / rendered.name / fmt::format("{:06d}.png", frame),
        {reinterpret_cast<const char*>(png.data()), png.size()});
  }

  void scan(const MapSurfels& surfels, const RigidMotion& T_local_lidar, int frame) {
    const PointCloud scan_lidar = cast_lidar(surfels, T_local_lidar, lidar_, seconds(stamp(frame)));
    figures_.points += double(scan_lidar.size());
    if (scan_lidar.empty()) {
      ++figures_.empty;
    } else {
      writer_.write_scan(frame, stamp(frame), scan_lidar, ScanFile::kKittiBin);
    }
  }

  const RenderJob& job_;
  LidarPattern lidar_;  // cut at the reach
  ColorDisplay display_;
  MapWindow window_;
  GenericDriveWriter writer_;
  ColouredSurfels coloured_;
  int drawn_version_ = 0;
  RenderFigures figures_;
};

}  // namespace

RenderFigures render_drive(const MapReader& map, const RenderJob& job,
                           const std::function<void(int, int)>& progress) {
  const auto held = map.hold_state();
  DriveRenderer renderer(map, job);
  const int frames = static_cast<int>(job.T_local_lidar.size());
  for (int frame = 0; frame < frames; ++frame) {
    renderer.render(frame);
    progress(frame + 1, frames);
  }
  return renderer.finish();
}

}  // namespace fovea
