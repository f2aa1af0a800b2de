#include "fovea/simulation/tracklet_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fovea {
namespace {

using Eigen::Vector3d;

constexpr double kReach = 140;  // m: chunks whose middle is nearer can have returns
/// A thing that is so much farther (m) than in the frame before is another: traffic without end
/// reuses its cars.
constexpr double kJump = 20;
constexpr std::size_t kRays = 48;  // towards each thing, for its occlusion

std::array<Vector3d, 8> corners_of(const Eigen::AlignedBox3d& box, const RigidMotion& T) {
  std::array<Vector3d, 8> corners;
  for (int k = 0; k < 8; ++k) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(k);
    corners[static_cast<std::size_t>(k)] = T * box.corner(type);
  }
  return corners;
}

/// KITTI's boxes turn about the LiDAR's z axis alone. The LiDAR is tilted against the road by less
/// than a degree, which moves the corners of a car by no more than its own noise.
RigidMotion upright(const RigidMotion& T) {
  RigidMotion flat = RigidMotion::Identity();
  flat.translation() = T.translation();
  const double heading = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
  flat.linear() = Eigen::AngleAxisd(heading, Vector3d::UnitZ()).matrix();
  return flat;
}

std::string box_text(const BoxLabel& box, bool first) {
  const Vector3d& t = box.T_lidar_box.translation();
  const double rz = std::atan2(box.T_lidar_box.linear()(1, 0), box.T_lidar_box.linear()(0, 0));
  constexpr int kInterpolated = 1, kLabelled = 2;
  return fmt::format(
      "\t\t\t<item{}>\n"
      "\t\t\t\t<tx>{:.9g}</tx>\n\t\t\t\t<ty>{:.9g}</ty>\n\t\t\t\t<tz>{:.9g}</tz>\n"
      "\t\t\t\t<rx>0</rx>\n\t\t\t\t<ry>0</ry>\n\t\t\t\t<rz>{:.9g}</rz>\n"
      "\t\t\t\t<state>{}</state>\n"
      "\t\t\t\t<occlusion>{}</occlusion>\n\t\t\t\t<occlusion_kf>1</occlusion_kf>\n"
      "\t\t\t\t<truncation>{}</truncation>\n"
      "\t\t\t\t<amt_occlusion>-1</amt_occlusion>\n\t\t\t\t<amt_occlusion_kf>-1</amt_occlusion_kf>\n"
      "\t\t\t\t<amt_border_l>-1</amt_border_l>\n\t\t\t\t<amt_border_r>-1</amt_border_r>\n"
      "\t\t\t\t<amt_border_kf>-1</amt_border_kf>\n"
      "\t\t\t</item>\n",
      first ? " class_id=\"3\" tracking_level=\"0\" version=\"2\"" : "", t.x(), t.y(), t.z(), rz,
      box.seen ? kLabelled : kInterpolated, static_cast<int>(box.occlusion),
      static_cast<int>(box.truncation));
}

/// The returns of one thing in one scan.
struct Returns {
  int count = 0;
  double time = 0;  // sum of their times (s from the stamp)
};

}  // namespace

/// What a frame's labels are made from.
struct TrackletLabels::Sight {
  double stamp = 0;
  RigidMotion T_lidar_world = RigidMotion::Identity();
  std::map<std::uint32_t, Returns> returns;  // by surface
  const RayCaster* caster = nullptr;
  RayCaster::Moment moment;
};

std::string tracklets_text(const std::vector<BoxTrack>& tracks) {
  // Boost's archives say what class an item is of where the class occurs first, and only there.
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"9\">\n"
      "<tracklets class_id=\"0\" tracking_level=\"0\" version=\"0\">\n"
      "\t<count>{}</count>\n\t<item_version>1</item_version>\n",
      tracks.size());
  bool first = true;
  for (const BoxTrack& track : tracks) {
    text += fmt::format(
        "\t<item{}>\n\t\t<objectType>{}</objectType>\n"
        "\t\t<h>{:.9g}</h>\n\t\t<w>{:.9g}</w>\n\t\t<l>{:.9g}</l>\n"
        "\t\t<first_frame>{}</first_frame>\n"
        "\t\t<poses{}>\n\t\t\t<count>{}</count>\n\t\t\t<item_version>2</item_version>\n",
        first ? " class_id=\"1\" tracking_level=\"0\" version=\"1\"" : "", track.type,
        track.size.z(), track.size.y(), track.size.x(), track.first_frame,
        first ? " class_id=\"2\" tracking_level=\"0\" version=\"0\"" : "", track.boxes.size());
    for (const BoxLabel& box : track.boxes) {
      text += box_text(box, first);
      first = false;
    }
    text += "\t\t</poses>\n\t\t<finished>1</finished>\n\t</item>\n";
  }
  return text + "</tracklets>\n</boost_serialization>\n";
}

BoxTruncation truncation_of(const std::array<Vector3d, 8>& corners_cam, const Camera& camera) {
  Eigen::AlignedBox2d extent;
  bool cut = false;
  for (const Vector3d& corner : corners_cam) {
    const auto pixel = camera.project(corner);
    if (pixel) {
      extent.extend(*pixel);
    } else {
      cut = true;
    }
  }
  if (extent.isEmpty()) return BoxTruncation::kBehindImage;
  const Eigen::AlignedBox2d image(Eigen::Vector2d(0, 0),
                                  Eigen::Vector2d(camera.width - 1, camera.height - 1));
  if (!image.intersects(extent)) return BoxTruncation::kOutOfImage;
  return cut || !image.contains(extent) ? BoxTruncation::kTruncated : BoxTruncation::kInImage;
}

TrackletLabels::TrackletLabels(const Scenery& scenery, const VehicleMotion& motion, const Rig& rig)
    : scenery_(scenery), motion_(motion), rig_(rig) {
  for (const Model& model : scenery.models()) {
    Eigen::AlignedBox3d& box = bounds_.emplace_back();
    for (const Vector3d& p : model.mesh.position) box.extend(p);
  }
}

std::vector<Placement> TrackletLabels::things_near(const Vector3d& lidar_world, double time) {
  std::vector<Placement> things;
  for (const ChunkPlace& chunk : scenery_.chunks_near(lidar_world.head<2>(), kReach)) {
    const auto known = standing_.find(chunk.id);
    const std::vector<Placement>& standing =
        known != standing_.end()
            ? known->second
            : standing_.emplace(chunk.id, scenery_.chunk(chunk.id).standing).first->second;
    things.insert(things.end(), standing.begin(), standing.end());
  }
  for (const Placement& mover : scenery_.movers(time, motion_.way(time))) {
    if (!scenery_.models()[mover.model].label.empty()) things.push_back(mover);
  }
  return things;
}

BoxOcclusion TrackletLabels::occlusion_of(const Placement& thing, const Sight& sight) const {
  if (rig_.cameras.empty()) return BoxOcclusion::kFully;
  const Vector3d eye =
      (rig_.cameras.front().T_cam_lidar * sight.T_lidar_world).inverse() * Vector3d::Zero();
  const TriangleMesh& mesh = scenery_.models()[thing.model].mesh;
  const std::size_t step = std::max<std::size_t>(1, mesh.size() / kRays);
  int cast = 0, seen = 0;
  for (std::size_t t = 0; t < mesh.size(); t += step) {
    const Vector3d target =
        thing.T_world_model * ((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3);
    const Vector3d along = target - eye;
    const auto hit =
        sight.caster->cast(sight.moment, eye, along.normalized(), 0.01, along.norm() + 0.05);
    ++cast;
    seen += hit && hit->surface == thing.surface;
  }
  constexpr double kWhole = 0.9, kNothing = 0.1;  // shares up to which an annotator would say so
  if (seen > kWhole * cast) return BoxOcclusion::kVisible;
  return seen > kNothing * cast ? BoxOcclusion::kPartly : BoxOcclusion::kFully;
}

BoxLabel TrackletLabels::label_of(const Placement& thing, const Sight& sight) const {
  BoxLabel label;
  Placement passed = thing;  // where it was when the sweep passed it
  if (const auto found = sight.returns.find(thing.surface); found != sight.returns.end()) {
    label.seen = true;
    const double time = sight.stamp + found->second.time / found->second.count;
    if ((thing.surface & Scenery::kMoving) != 0) {
      const auto movers = scenery_.movers(time, motion_.way(time));
      const auto same = std::find_if(movers.begin(), movers.end(), [&](const Placement& mover) {
        return mover.surface == thing.surface;
      });
      if (same != movers.end()) passed = *same;
    }
  }
  const Eigen::AlignedBox3d& bounds = bounds_[thing.model];
  const Vector3d bottom(bounds.center().x(), bounds.center().y(), bounds.min().z());
  label.T_lidar_box =
      upright(sight.T_lidar_world * passed.T_world_model * Eigen::Translation3d(bottom));
  label.occlusion = occlusion_of(thing, sight);
  label.truncation = BoxTruncation::kOutOfImage;
  if (!rig_.cameras.empty()) {
    const Camera& camera = rig_.cameras.front();
    label.truncation = truncation_of(
        corners_of(bounds, camera.T_cam_lidar * sight.T_lidar_world * thing.T_world_model), camera);
  }
  return label;
}

TrackletLabels::Track& TrackletLabels::track_of(const Placement& thing, int frame) {
  if (const auto open = open_.find(thing.surface); open != open_.end()) {
    Track& track = tracks_[open->second];
    const Vector3d moved = thing.T_world_model.translation() - track.T_world_model.translation();
    if (track.last_frame == frame - 1 && moved.norm() < kJump) return track;
  }
  open_[thing.surface] = tracks_.size();
  Track& track = tracks_.emplace_back();
  track.labels.type = scenery_.models()[thing.model].label;
  track.labels.size = bounds_[thing.model].sizes();
  track.labels.first_frame = frame;
  return track;
}

void TrackletLabels::add(int frame, double stamp, const SimulatedScan& scan,
                         const RayCaster& caster) {
  Sight sight;
  sight.stamp = stamp;
  const RigidMotion T_world_lidar = motion_.T_world_vehicle(stamp) * rig_.T_vehicle_lidar;
  sight.T_lidar_world = T_world_lidar.inverse();
  sight.caster = &caster;
  sight.moment = caster.moment(stamp, motion_.way(stamp));
  for (const TruthPoint& point : scan.truth) {
    Returns& returns = sight.returns[point.surface];
    ++returns.count;
    returns.time += point.time;
  }
  for (const Placement& thing : things_near(T_world_lidar.translation(), stamp)) {
    const bool seen = sight.returns.contains(thing.surface);
    const auto open = open_.find(thing.surface);
    const bool follows = open != open_.end() && tracks_[open->second].last_frame == frame - 1;
    if (!seen && !follows) continue;
    Track& track = track_of(thing, frame);
    track.labels.boxes.push_back(label_of(thing, sight));
    track.T_world_model = thing.T_world_model;
    track.last_frame = frame;
    if (seen) track.until_seen = track.labels.boxes.size();
  }
}

std::vector<BoxTrack> TrackletLabels::tracks() const {
  std::vector<BoxTrack> tracks;
  for (const Track& track : tracks_) {
    if (track.until_seen == 0) continue;
    BoxTrack& kept = tracks.emplace_back(track.labels);
    kept.boxes.resize(track.until_seen);
  }
  return tracks;
}

}  // namespace fovea
