#include "fovea/pipeline/map_light.h"

#include <algorithm>

namespace fovea {
namespace {

/// A place counts as revisited from this number of compared points on. Fewer are far away, and
/// their colors differ: means over larger patches.
constexpr std::size_t kRevisitedPoints = 2000;

/// The earlier submap of which an image shows most.
std::optional<std::size_t> earlier_submap(const MapDifferences& differences) {
  std::optional<std::size_t> best;
  std::size_t most = 0;
  for (const auto& [submap, of_submap] : differences.earlier) {
    if (of_submap.size() > most) best = submap, most = of_submap.size();
  }
  return best;
}

}  // namespace

void MapLight::follow(std::size_t submap, const RigidMotion& T_odom_lidar, TileMap& map) {
  if (submap < graph_.gains().size()) return;
  graph_.optimize();
  while (graph_.gains().size() <= submap) {
    graph_.add_submap((T_odom_lidar.translation() - opened_odom_).norm());
    opened_odom_ = T_odom_lidar.translation();
  }
  map.set_gains(graph_.gains());
}

void MapLight::learn_response(const std::vector<Eigen::Vector3f>& points_cam,
                              const ImagePyramid& image, const Camera& camera,
                              const RigidMotion& T_odom_cam, double footprint) {
  cameras_[camera.index].response.add(points_cam, image, camera, T_odom_cam, footprint);
}

LogGain MapLight::gain_before(int camera) const {
  const auto found = cameras_.find(camera);
  if (found == cameras_.end() || !found->second.gain) return LogGain::Zero();
  return *found->second.gain - graph_.gains()[found->second.submap];
}

ViewRecord MapLight::next(int camera, const MapDifferences& differences,
                          std::optional<double> exposure, TileMap& map) {
  const std::size_t submap = graph_.gains().size() - 1;
  ViewRecord view;
  view.camera = camera;
  view.response = response(camera);
  std::optional<LogGain> gain =
      gain_of(differences.recent, differences.colors, view.response.offset);
  if (const auto earlier = earlier_submap(differences)) {
    const CodeDifferences& seen = differences.earlier.at(*earlier);
    const std::optional<LogGain> to_earlier = gain_of(seen);
    if (gain && seen.size() >= kRevisitedPoints && !revisiting_.contains(submap)) {
      const LogGain stored = *to_earlier + graph_.gains()[*earlier];
      view.revisit = {static_cast<int>(*earlier), stored.cast<double>().matrix()};
    }
    if (!gain) gain = to_earlier;  // a place where the drive goes on after a pause
  }
  const LogGain stored = gain.value_or(gain_before(camera)) + graph_.gains()[submap];
  view.log2_gain = stored.cast<double>().matrix();
  if (const std::optional<LogGain> color = gain_of(differences.ground)) {
    constexpr float kOne = float(kColorCodeOfOne) / float(kColorCodesPerStop);
    view.log2_color = (*color - kOne - graph_.gains()[submap]).cast<double>().matrix();
  }
  replay(view, exposure, map);
  return view;
}

void MapLight::replay(const ViewRecord& view, std::optional<double> exposure, TileMap& map) {
  if (!view.log2_gain) return;
  const std::size_t submap = graph_.gains().size() - 1;
  const LogGain gain = view.log2_gain->cast<float>().array();
  CameraState& camera = cameras_[view.camera];
  camera.gain = gain;
  camera.submap = submap;
  ImageLevel level{view.camera, gain, {}, exposure};
  if (view.log2_color) level.color = view.log2_color->cast<float>().array();
  graph_.add(level);
  if (!view.revisit) return;
  // The image shows both: its gain is higher where the stored color is darker.
  const LogGain to_earlier = view.revisit->log2_gain.cast<float>().array();
  graph_.add_revisit(static_cast<std::size_t>(view.revisit->submap), submap, to_earlier - gain);
  revisiting_.insert(submap);
  graph_.optimize();
  map.set_gains(graph_.gains());
}

ViewLight MapLight::light(const ViewRecord& view, std::size_t submap) const {
  ViewLight light = view.light();
  light.gain -= graph_.gains()[submap];
  return light;
}

bool MapLight::needs_images(const std::vector<FrameRecord>& records) {
  std::map<int, std::size_t> images;
  for (const FrameRecord& record : records) {
    for (const ViewRecord& view : record.views) {
      if (!view.log2_gain) continue;
      cameras_[view.camera].response.resume(++images[view.camera], view.response);
    }
  }
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [](const auto& camera) { return !camera.second.response.is_finished(); });
}

}  // namespace fovea
