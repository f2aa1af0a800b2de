#include "fovea/simulation/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/simulation/camera_model.h"
#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/image_schedule.h"
#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/simulation_config.h"
#include "fovea/simulation/simulation_writer.h"
#include "fovea/simulation/tracklet_labels.h"
#include "fovea/simulation/world_export.h"

namespace fovea {
namespace {

constexpr double kSeen = 260;  // m: chunks whose middle is nearer are there for rays

/// m: ... and are part of the truth's world: what the LiDAR reaches.
double truth_reach(const LidarOptions& lidar) {
  return std::clamp(lidar.max_range + 20, 140.0, kSeen);
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
        writer_(make_simulation_writer(options, root)),
        scenery_(make_scenery(options)),
        motion_(scenery_->path(), scenery_->lane_offset(), options.vehicle, options.pass_seed()),
        rig_(make_rig(options)),
        caster_(*scenery_),
        shader_(caster_, options.light),
        labels_(*scenery_, motion_, rig_) {
    // All passes share one frame `local`: that of the first.
    const VehicleMotion first(scenery_->path(), scenery_->lane_offset(), options.vehicle,
                              options.seed);
    T_world_local_.translation() = scenery_->local_origin().value_or(
        (first.T_world_vehicle(0) * rig_.T_vehicle_lidar).translation());
    truth_.resize(rig_.cameras.size());
    for (const SimulatedCamera& camera : options.camera.cameras) {
      schedules_.push_back(image_schedule(options, camera));
      if (image_count(schedules_.back()) > 0) continue;
      throw ConfigError(fmt::format("camera {} takes no image during the drive", camera.number),
                        "camera.rate", "give a higher rate or more frames");
    }
  }

  void simulate_frame(int frame) {
    const double time = seconds(stamp_of(frame, options_) - stamp_of(0, options_));
    const Eigen::Vector2d place = T_world_lidar(time).translation().head<2>();
    caster_.move_to(place, kSeen);
    for (const ChunkPlace& chunk : scenery_->chunks_near(place, truth_reach(options_.lidar)))
      chunks_.insert(chunk.id);
    lidar_poses_ += pose_line(T_world_local_.inverse() * T_world_lidar(time));

    const SimulatedScan scan = simulate_scan(caster_, motion_, rig_.T_vehicle_lidar, options_.lidar,
                                             options_.pass_seed(), frame, time);
    if (has_tracklets()) labels_.add(frame, time, scan, caster_);
    write_further_scans(frame, time);
    std::vector<Picture> pictures;
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
      for (const Shot& shot : schedules_[k][static_cast<std::size_t>(frame)]) {
        pictures.push_back(picture(k, frame, shot));
      }
    }
    write(frame, scan, pictures);
  }

  std::filesystem::path finish() {
    writer_->write_texts(rig_, simulate_navigation(motion_, rig_, T_world_local_, options_),
                         options_);
    if (options_.imu.rate > 0) writer_->write_imu(simulate_imu(motion_, rig_, options_));
    if (options_.wheels.rate > 0) writer_->write_wheels(simulate_wheels(motion_, rig_, options_));
    if (has_tracklets()) {
      writer_->write_file("tracklet_labels.xml", tracklets_text(labels_.tracks()));
    }
    write_truth_texts();
    write_world(export_world(*scenery_, chunks_, T_world_local_.inverse()),
                writer_->truth_folder());
    return writer_->finish();
  }

 private:
  /// Each LiDAR has its own noise. The truth of points is that of the first LiDAR alone.
  void write_further_scans(int frame, double time) {
    constexpr unsigned kSeedStep = 7919;
    for (std::size_t k = 0; k < options_.further_lidars.size(); ++k) {
      const FurtherLidarOptions& further = options_.further_lidars[k];
      const SimulatedScan scan = simulate_scan(
          caster_, motion_, rig_.T_vehicle_lidar * rig_.T_lidar_further[k], further.lidar,
          static_cast<int>(unsigned(options_.pass_seed()) + kSeedStep * unsigned(k + 1)), frame,
          time + further.stamp_offset);
      writer_->write_further_scan(k, frame, scan);
    }
  }

  /// What one camera makes of a shot: an image, the truth of a frame, or both.
  struct Picture {
    std::size_t camera;
    Shot shot;
    Image image, perfect;
    std::vector<float> depth;
    double exposure;
  };
  /// The truth of a camera that grows with the drive.
  struct CameraTruth {
    std::string poses, exposures, white_balances;  // by frame
    std::map<int, std::string> images;             // by number
  };

  /// KITTI's boxes turn about the LiDAR's z axis alone, which must be upright for that.
  bool has_tracklets() const {
    constexpr double kMaxTilt = 5 * kDegree;
    return rig_.T_vehicle_lidar.linear()(2, 2) > std::cos(kMaxTilt);
  }

  RigidMotion T_world_lidar(double time) const {
    return motion_.T_world_vehicle(time) * rig_.T_vehicle_lidar;
  }

  CameraModel::View view(const Camera& camera, double time) const {
    return {T_world_lidar(time) * camera.T_cam_lidar.inverse(),
            caster_.moment(time, motion_.way(time))};
  }

  /// What the camera's optics and shutter make of the light.
  Rendering taken(std::size_t k, const CameraModel::View& middle, double time) const {
    const CameraModel model(caster_, shader_, rig_.optics[k]);
    const double readout = options_.camera.rolling_shutter;
    if (readout == 0) return model.render(middle.T_world_cam, middle.moment);
    return model.render_rows(
        [&](double row) { return view(rig_.cameras[k], time + readout * (row - 0.5)); });
  }

  Picture picture(std::size_t k, int frame, const Shot& shot) {
    const Camera& camera = rig_.cameras[k];
    const double time = seconds(shot.stamp - stamp_of(0, options_)) + options_.camera.trigger_delay;
    const CameraModel::View middle = view(camera, time);
    const ImageLight light =
        image_light_at(options_.camera, camera.index, time, options_.pass_seed());
    note_truth(k, frame, shot, T_world_local_.inverse() * middle.T_world_cam, light);
    Picture picture{k, shot, {}, {}, {}, light.exposure};
    Rendering seen;
    if (shot.image) {
      seen = taken(k, middle, time);
      picture.image = develop(seen, development(k, *shot.image, light));
    }
    if (!shot.is_of_frame) return picture;
    // The truth is that of the rectified camera, all of it at one time.
    const bool perfect = rig_.optics[k].lens.model() == LensModel::kNone &&
                         options_.camera.rolling_shutter == 0 && shot.image;
    if (!perfect) {
      seen = CameraModel(caster_, shader_, camera).render(middle.T_world_cam, middle.moment);
    }
    Development plain;
    plain.grey = options_.camera.cameras[k].grey;
    picture.perfect = develop(seen, plain);
    picture.depth = std::move(seen.depth);
    return picture;
  }

  Development development(std::size_t k, int image, const ImageLight& light) const {
    Development real;
    real.grey = options_.camera.cameras[k].grey;
    real.exposure = light.exposure;
    real.white_balance = light.white_balance;
    real.center = {rig_.optics[k].cx, rig_.optics[k].cy};
    real.vignetting = options_.camera.vignetting;
    real.noise = options_.camera.noise;
    real.seed = Random::of_item(static_cast<std::uint64_t>(options_.pass_seed()),
                                static_cast<std::uint64_t>(rig_.cameras[k].index),
                                static_cast<std::uint64_t>(image))
                    .next();
    return real;
  }

  void note_truth(std::size_t k, int frame, const Shot& shot, const RigidMotion& T_local_cam,
                  const ImageLight& light) {
    CameraTruth& truth = truth_[k];
    if (shot.is_of_frame) {
      truth.poses += pose_line(T_local_cam);
      truth.exposures += fmt::format("{:.9g}\n", light.exposure);
      const Eigen::Vector3f& gains = light.white_balance;
      truth.white_balances +=
          fmt::format("{:.9g} {:.9g} {:.9g}\n", gains.x(), gains.y(), gains.z());
    }
    if (!shot.image) return;
    std::string pose = pose_line(T_local_cam);
    std::replace(pose.begin(), pose.end(), ' ', ',');
    truth.images[*shot.image] =
        fmt::format("{},{},{},{:.9g},{}", *shot.image, shot.stamp,
                    shot.is_of_frame ? std::to_string(frame) : "", light.exposure, pose);
  }

  /// Compressing the images costs as much as drawing them: all files of a frame at once.
  void write(int frame, const SimulatedScan& scan, const std::vector<Picture>& pictures) {
    parallel_for(2 + 3 * pictures.size(), 1, [&](std::size_t task) {
      if (task == 0) return writer_->write_scan(frame, scan);
      if (task == 1) return writer_->write_truth(frame, scan.truth);
      const Picture& picture = pictures[(task - 2) / 3];
      const Camera& camera = rig_.cameras[picture.camera];
      const Shot& shot = picture.shot;
      const std::size_t file = (task - 2) % 3;
      if (file == 0 && shot.image) {
        writer_->write_image(camera.index, *shot.image, shot.stamp, picture.image);
        if (options_.camera.exposure_times) {
          writer_->write_exposure(camera.index, *shot.image, picture.exposure);
        }
      } else if (file == 1 && shot.is_of_frame) {
        writer_->write_perfect_image(camera.index, frame, picture.perfect);
      } else if (file == 2 && shot.is_of_frame) {
        writer_->write_depth(camera.index, frame, camera.width, camera.height, picture.depth);
      }
    });
  }

  void write_camera_truth(std::size_t k) {
    const std::string folder = fmt::format("truth/image_{:02d}/", rig_.cameras[k].index);
    writer_->write_file(folder + "poses.txt", truth_[k].poses);
    writer_->write_file(folder + "exposure.txt", truth_[k].exposures);
    writer_->write_file(folder + "white_balance.txt", truth_[k].white_balances);
    // Else each frame has the image of its number.
    if (image_rate(options_.camera, options_.camera.cameras[k]) == 0) return;
    std::string images = "index,time_ns,frame,exposure,r11,r12,r13,x,r21,r22,r23,y,r31,r32,r33,z\n";
    for (const auto& [number, line] : truth_[k].images) images += line;
    writer_->write_file(folder + "images.csv", images);
  }

  void write_truth_texts() {
    writer_->write_file("truth/poses.txt", lidar_poses_);
    nlohmann::json cameras = nlohmann::json::array();
    for (std::size_t k = 0; k < rig_.cameras.size(); ++k) {
      write_camera_truth(k);
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
  std::unique_ptr<SimulationWriter> writer_;
  std::unique_ptr<Scenery> scenery_;
  VehicleMotion motion_;
  Rig rig_;
  RayCaster caster_;
  Shader shader_;
  TrackletLabels labels_;
  RigidMotion T_world_local_ = RigidMotion::Identity();
  std::set<std::uint32_t> chunks_;  // seen so far
  std::string lidar_poses_;
  std::vector<std::vector<std::vector<Shot>>> schedules_;  // by place in the rig and frame
  std::vector<CameraTruth> truth_;                         // by place in the rig
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
