#include "fovea/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fovea/base/parallel.h"
#include "fovea/base/random.h"
#include "fovea/simulation/camera_model.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/drive_writer.h"
#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/simulation_config.h"
#include "fovea/simulation/tracklet_labels.h"
#include "fovea/simulation/world_export.h"

namespace fovea {
namespace {

constexpr double kSeen = 260;  // m: chunks whose middle is nearer are there for rays

/// m: ... and are part of the truth's world: what the LiDAR reaches.
double truth_reach(const LidarOptions& lidar) {
  return std::clamp(lidar.max_range + 20, 140.0, kSeen);
}

/// What a drive takes on disk, about: scans and their truth, images with perfect image and depth.
std::uintmax_t expected_size(const SimulationOptions& options) {
  constexpr double kReturn = 44, kPixel = 4, kWorld = 60e6;  // bytes
  const double beams = double(ring_elevations(options.lidar).size()) * sweep_columns(options.lidar);
  const double frame = kReturn * beams + kPixel * options.camera.width * options.camera.height *
                                             static_cast<double>(options.camera.cameras.size());
  return static_cast<std::uintmax_t>(kWorld + frame * options.frames);
}

/// One line of a KITTI pose file: 3x4, row by row.
std::string pose_line(const RigidMotion& T) {
  std::string line;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      line += fmt::format("{}{:.12g}", line.empty() ? "" : " ", T.matrix()(r, c));
    }
  }
  return line + "\n";
}

class Simulation {
 public:
  Simulation(const SimulationOptions& options, const std::filesystem::path& root)
      : options_(options),
        writer_(make_drive_writer(options, root)),
        scenery_(make_scenery(options)),
        motion_(scenery_->path(), scenery_->lane_offset(), options.vehicle, options.pass_seed()),
        rig_(make_rig(options)),
        caster_(*scenery_),
        shader_(caster_, options.light),
        labels_(*scenery_, motion_, rig_) {
    // All passes share one frame `local`: that of the first.
    const VehicleMotion first(scenery_->path(), scenery_->lane_offset(), options.vehicle,
                              options.seed);
    T_world_local_.translation() = (first.T_world_vehicle(0) * rig_.T_vehicle_lidar).translation();
    camera_poses_.resize(rig_.cameras.size());
    exposures_.resize(rig_.cameras.size());
  }

  void simulate_frame(int frame) {
    const double time = seconds(stamp_of(frame, options_) - stamp_of(0, options_));
    const Eigen::Vector2d place = T_world_lidar(time).translation().head<2>();
    caster_.move_to(place, kSeen);
    for (const ChunkPlace& chunk : scenery_->chunks_near(place, truth_reach(options_.lidar)))
      chunks_.insert(chunk.id);
    lidar_poses_ += pose_line(T_world_local_.inverse() * T_world_lidar(time));

    const SimulatedScan scan =
        simulate_scan(caster_, motion_, rig_, options_.lidar, options_.pass_seed(), frame, time);
    if (has_tracklets()) labels_.add(frame, time, scan, caster_);
    std::vector<Picture> pictures;
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k)
      pictures.push_back(picture(k, frame, seconds(image_stamp(frame) - stamp_of(0, options_))));
    write(frame, scan, pictures);
  }

  std::filesystem::path finish() {
    writer_->write_texts(rig_, simulate_navigation(motion_, rig_, T_world_local_, options_),
                         options_);
    if (has_tracklets()) {
      writer_->write_file("tracklet_labels.xml", tracklets_text(labels_.tracks()));
    }
    write_truth_texts();
    write_world(export_world(*scenery_, chunks_, T_world_local_.inverse()),
                writer_->truth_folder());
    return writer_->finish();
  }

 private:
  struct Picture {
    Image image, perfect;
    std::vector<float> depth;
  };

  /// KITTI's boxes turn about the LiDAR's z axis alone, which must be upright for that.
  bool has_tracklets() const {
    constexpr double kMaxTilt = 5 * kDegree;
    return rig_.T_vehicle_lidar.linear()(2, 2) > std::cos(kMaxTilt);
  }

  /// Images are taken in the middle of the sweep.
  TimeNs image_stamp(int frame) const {
    return stamp_of(frame, options_) + from_seconds(sweep_middle(options_.lidar));
  }

  RigidMotion T_world_lidar(double time) const {
    return motion_.T_world_vehicle(time) * rig_.T_vehicle_lidar;
  }

  Picture picture(std::size_t k, int frame, double stamp) {
    const Camera& camera = rig_.cameras[k];
    const double time = stamp + options_.camera.trigger_delay;
    const RigidMotion T_world_cam = T_world_lidar(time) * camera.T_cam_lidar.inverse();
    const RayCaster::Moment moment = caster_.moment(time, motion_.way(time));
    Rendering taken = CameraModel(caster_, shader_, rig_.optics[k]).render(T_world_cam, moment);
    // The truth is that of the rectified camera.
    const bool distorted = rig_.optics[k].lens.model() != LensModel::kNone;
    Rendering rectified =
        distorted ? CameraModel(caster_, shader_, camera).render(T_world_cam, moment) : taken;
    const double exposure = exposure_at(options_.camera, camera.index, time, options_.pass_seed());
    camera_poses_[k] += pose_line(T_world_local_.inverse() * T_world_cam);
    exposures_[k] += fmt::format("{:.9g}\n", exposure);

    Development perfect, real;
    perfect.grey = real.grey = options_.camera.cameras[k].grey;
    real.exposure = exposure;
    real.vignetting = options_.camera.vignetting;
    real.noise = options_.camera.noise;
    real.seed =
        Random::of_item(static_cast<std::uint64_t>(options_.pass_seed()),
                        static_cast<std::uint64_t>(camera.index), static_cast<std::uint64_t>(frame))
            .next();
    return {develop(taken, real), develop(rectified, perfect), std::move(rectified.depth)};
  }

  /// Compressing the images costs as much as drawing them: all files of a frame at once.
  void write(int frame, const SimulatedScan& scan, const std::vector<Picture>& pictures) {
    parallel_for(2 + 3 * pictures.size(), 1, [&](std::size_t task) {
      if (task == 0) return writer_->write_scan(frame, scan);
      if (task == 1) return writer_->write_truth(frame, scan.truth);
      const std::size_t k = (task - 2) / 3;
      const Camera& camera = rig_.cameras[k];
      switch ((task - 2) % 3) {
        case 0:
          return writer_->write_image(camera.index, frame, image_stamp(frame), pictures[k].image);
        case 1:
          return writer_->write_perfect_image(camera.index, frame, pictures[k].perfect);
        default:
          return writer_->write_depth(camera.index, frame, camera.width, camera.height,
                                      pictures[k].depth);
      }
    });
  }

  void write_truth_texts() {
    writer_->write_file("truth/poses.txt", lidar_poses_);
    nlohmann::json cameras = nlohmann::json::array();
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
      const std::string folder = fmt::format("truth/image_{:02d}/", rig_.cameras[k].index);
      writer_->write_file(folder + "poses.txt", camera_poses_[k]);
      writer_->write_file(folder + "exposure.txt", exposures_[k]);
      cameras.push_back(rig_.cameras[k].index);
    }
    const GeodeticPoint& origin = options_.navigation.origin;
    const nlohmann::json truth{{"version", 1},
                               {"scene", to_string(options_.scene)},
                               {"seed", options_.seed},
                               {"frames", options_.frames},
                               {"cameras", cameras},
                               {"sweep_period", options_.lidar.period},
                               {"origin",
                                {{"latitude", origin.latitude},
                                 {"longitude", origin.longitude},
                                 {"altitude", origin.altitude}}},
                               {"config", to_toml(options_)}};
    writer_->write_file("truth/truth.json", truth.dump(2) + "\n");
  }

  SimulationOptions options_;
  std::unique_ptr<DriveWriter> writer_;
  std::unique_ptr<Scenery> scenery_;
  VehicleMotion motion_;
  Rig rig_;
  RayCaster caster_;
  Shader shader_;
  TrackletLabels labels_;
  RigidMotion T_world_local_ = RigidMotion::Identity();
  std::set<std::uint32_t> chunks_;  // seen so far
  std::string lidar_poses_;
  std::vector<std::string> camera_poses_, exposures_;
};

}  // namespace

std::filesystem::path simulate(const SimulationOptions& options, const std::filesystem::path& root,
                               const SimulationProgress& progress) {
  options.validate();
  Simulation simulation(options, root);
  check_free_space(root, expected_size(options));
  for (int frame = 0; frame < options.frames; ++frame) {
    simulation.simulate_frame(frame);
    if (progress && !progress(frame + 1, options.frames)) return {};
  }
  return simulation.finish();
}

}  // namespace fovea
