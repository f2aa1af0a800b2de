#include "fovea/pipeline/drive_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/median.h"
#include "fovea/errors.h"
#include "fovea/pipeline/drive_sensors.h"
#include "fovea/pipeline/scan_edges.h"

namespace fovea {
namespace {

/// Stamps of all frames: duration, step and pauses.
void check_stamps(const FrameSource& source, const std::vector<int>& frames, DriveCheck& check) {
  std::vector<std::pair<int, TimeNs>> stamps;
  for (const int frame : frames) {
    const auto stamp = source.stamp(frame);
    if (stamp) stamps.emplace_back(frame, *stamp);
    check.without_stamp += !stamp;
  }
  if (stamps.size() < 2) return;
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    steps.push_back(seconds(stamps[i].second - stamps[i - 1].second));
  }
  const double period = median_of(steps);
  check.period = period;
  check.duration = seconds(stamps.back().second - stamps.front().second);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] > 1 && steps[i] > 3 * period) check.gaps.push_back({stamps[i].first, steps[i]});
  }
}

/// Scans and images of some frames.
class FrameSample {
 public:
  FrameSample(const DriveInfo& drive, DriveCheck& check)
      : times_by_azimuth_(drive.times_by_azimuth), check_(check) {}

  void add(const Frame& frame) {
    const PointCloud& scan = frame.scan;
    sizes_.push_back(double(scan.size()));
    constexpr std::size_t kStep = 16;  // one point in so many
    for (std::size_t i = 0; i < scan.size(); i += kStep) ranges_.push_back(scan.position[i].norm());
    check_.has_point_times = check_.has_point_times || (!scan.time.empty() && !times_by_azimuth_);
    check_.has_intensity =
        check_.has_intensity || std::any_of(scan.intensity.begin(), scan.intensity.end(),
                                            [](float value) { return value > 0; });
    check_.points += scan.size();
    check_.dropped += frame.dropped_points;
    for (const MissingImage& missing : frame.missing_images) {
      for (DriveCheck::CameraFigures& camera : check_.cameras)
        camera.missing += camera.number == missing.camera;
    }
    for (const MissingScan& missing : frame.missing_scans) ++check_.missing_scans[missing.lidar];
  }

  void finish() {
    check_.points_per_scan = median_of(sizes_);
    check_.near_range = quantile(0.05), check_.far_range = quantile(0.95);
  }

 private:
  double quantile(double share) {
    if (ranges_.empty()) return 0;
    const auto place = ranges_.begin() + std::ptrdiff_t(share * double(ranges_.size() - 1));
    std::nth_element(ranges_.begin(), place, ranges_.end());
    return double(*place);
  }

  bool times_by_azimuth_;
  DriveCheck& check_;
  std::vector<double> sizes_;
  std::vector<float> ranges_;
};

void check_cameras(const DriveInfo& drive, DriveCheck& check) {
  for (std::size_t slot = 0; slot < drive.calibration.cameras.size(); ++slot) {
    const Camera& camera = drive.calibration.cameras[slot];
    DriveCheck::CameraFigures& figures = check.cameras.emplace_back();
    figures.number = camera.index, figures.width = camera.width, figures.height = camera.height;
    figures.focal_px = camera.fx;
    figures.delay = camera.image_delay;
    figures.has_exposures =
        slot < drive.image_exposures.size() && !drive.image_exposures[slot].empty();
    figures.has_mask = drive.mask(camera.index) != nullptr;
  }
}

void check_navigation(const DriveInfo& drive, DriveCheck& check) {
  if (!drive.navigation) return;
  check.navigation_poses = drive.navigation->poses().size();
  std::vector<double> stated;
  for (const double accuracy : drive.navigation_accuracy) {
    if (accuracy > 0 && std::isfinite(accuracy)) stated.push_back(accuracy);
  }
  if (!stated.empty()) check.navigation_accuracy = median_of(std::move(stated));
}

std::string motion_plan(const DriveInfo& drive, const DriveCheck& check) {
  if (drive.sweep_compensated) return "the motion during a sweep is undone already";
  if (check.has_point_times)
    return "the motion during a sweep is undone by the times of the points";
  const SweepTiming& sweep = drive.sweep;
  const bool is_clockwise = sweep.direction == SweepDirection::kClockwise;
  return fmt::format(
      "the points have no times: the motion is undone for {} sweeps of {:.4g} s from {:.0f} "
      "degrees on, stamped at {:.2g} of the sweep",
      is_clockwise ? "clockwise" : "counterclockwise", sweep.period,
      sweep.start_azimuth * 180 / std::numbers::pi, sweep.stamp_phase);
}

std::string poses_plan(const DriveInfo& drive) {
  std::vector<std::string> sources;
  if (drive.imu) sources.emplace_back("the IMU");
  if (drive.imu && drive.wheels) sources.emplace_back("the wheels");
  if (drive.navigation) sources.emplace_back("the navigation");
  if (sources.empty()) return "poses: registration of the scans alone, from constant velocity";
  return fmt::format("poses: registration of the scans, begun by {}", fmt::join(sources, " and "));
}

void make_plan(const DriveInfo& drive, DriveCheck& check) {
  std::vector<int> numbers;
  numbers.reserve(drive.calibration.cameras.size());
  for (const Camera& camera : drive.calibration.cameras) numbers.push_back(camera.index);
  check.plan.push_back(
      numbers.empty() ? "the map has no colors: the drive has no cameras, or none is used"
                      : fmt::format("camera{} {} color{} the map", numbers.size() == 1 ? "" : "s",
                                    fmt::join(numbers, ", "), numbers.size() == 1 ? "s" : ""));
  if (const std::size_t unused = drive.unused_cameras.size(); unused > 0) {
    check.plan.push_back(fmt::format("camera{} {} {} not used: choose by --cameras",
                                     unused == 1 ? "" : "s", fmt::join(drive.unused_cameras, ", "),
                                     unused == 1 ? "is" : "are"));
  }
  check.plan.push_back(poses_plan(drive));
  check.plan.push_back(drive.origin ? "the map is georeferenced" : "the map is not georeferenced");
  check.plan.push_back(motion_plan(drive, check));
  if (!drive.has_time_stamps)
    check.plan.emplace_back("the drive has no time stamps: 10 Hz is assumed");
}

void find_oddities(const DriveInfo& drive, DriveCheck& check) {
  const auto odd = [&](std::string text) { check.oddities.push_back(std::move(text)); };
  for (const DriveCheck::Gap& gap : check.gaps) {
    odd(fmt::format("a pause of {:.1f} s after frame {}", gap.seconds, gap.frame));
  }
  if (check.without_stamp > 0 && drive.has_time_stamps) {
    odd(fmt::format("{} frames have no time stamp", check.without_stamp));
  }
  for (const auto& [reason, count] : check.skipped) {
    odd(fmt::format("{} of {} frames read cannot be used: {}", count, check.sampled, reason));
  }
  for (const DriveCheck::CameraFigures& camera : check.cameras) {
    if (camera.missing == 0) continue;
    odd(fmt::format("camera {} has no image for {} of {} frames read", camera.number,
                    camera.missing, check.sampled));
  }
  for (const auto& [lidar, count] : check.missing_scans) {
    odd(fmt::format("LiDAR {} has no scan for {} of {} frames read", lidar, count, check.sampled));
  }
  constexpr double kMuch = 0.01;  // share
  const std::size_t faulty = check.dropped.faulty();
  if (double(faulty) > kMuch * double(check.points + faulty)) {
    odd(fmt::format("{} of {} points cannot be used: {}", faulty, check.points + faulty,
                    reasons_of(check.dropped)));
  }
  constexpr double kTooNear = 2;  // m
  if (check.far_range < kTooNear)
    odd(fmt::format("95 % of the points are nearer than {:.2f} m", check.far_range));
}

}  // namespace

DriveCheck check_drive(const FrameSource& source, int samples) {
  const DriveInfo& drive = source.info();
  const std::vector<int> frames = drive.frame_indices();
  DriveCheck check;
  check.frames = frames.size();
  check_stamps(source, frames, check);
  check_cameras(drive, check);
  FrameSample sample(drive, check);
  const std::size_t step =
      std::max<std::size_t>(1, (frames.size() + std::size_t(samples) - 1) / std::size_t(samples));
  std::string first_problem;
  for (std::size_t i = 0; i < frames.size(); i += step) {
    const LoadedFrame loaded = source.load(frames[i]);
    ++check.sampled;
    if (const auto* frame = std::get_if<Frame>(&loaded)) {
      sample.add(*frame);
      continue;
    }
    const auto& skipped = std::get<SkippedFrame>(loaded);
    ++check.skipped[to_string(skipped.reason)];
    if (first_problem.empty()) first_problem = skipped.detail;
  }
  if (frames.empty()) {
    throw InputError("the drive has no frames", drive.path.string(),
                     "see docs/drives.md for what is read");
  }
  if (check.points == 0) {
    throw InputError(
        fmt::format("none of {} frames read can be used ({})", check.sampled, first_problem),
        drive.path.string(), "see docs/drives.md for what is read");
  }
  sample.finish();
  check.lidars = mounted_lidars(source);
  check_navigation(drive, check);
  make_plan(drive, check);
  find_oddities(drive, check);
  return check;
}

Image calibration_overlay(const FrameSource& source, int frame, std::size_t slot) {
  const LoadedFrame loaded = source.load(frame);
  const auto* read = std::get_if<Frame>(&loaded);
  if (read == nullptr || slot >= read->images.size() || read->images[slot].empty()) {
    throw InputError(fmt::format("frame {} has no image of this camera", frame),
                     source.info().path.string(), "choose another --frame or --camera");
  }
  const Image& photograph = read->images[slot];
  const Camera camera = source.info().camera_at(slot, frame);
  Image picture(photograph.width, photograph.height, 3);
  for (std::size_t i = 0; i < picture.data.size(); ++i) {
    const std::size_t from = photograph.channels == 3 ? i : i / 3;
    picture.data[i] = static_cast<std::uint8_t>(photograph.data[from] / 2);
  }
  constexpr double kNear = 3, kFar = 25;               // m, red and blue
  const int reach = std::max(1, picture.width / 600);  // of a dot, pixels
  std::vector<Eigen::Vector3d> dots;                   // LiDAR frame
  for (const LidarEdges& edges :
       scan_edges(read->scan, camera, source.info(), std::nullopt, /*max_range=*/60)) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      dots.emplace_back(0.5 *
                        (edges.inside.position[i] + edges.outside.position[i]).cast<double>());
    }
  }
  for (const Eigen::Vector3d& p_lidar : dots) {
    const auto pixel = camera.project(camera.T_cam_lidar * p_lidar);
    if (!pixel || !camera.in_view(*pixel)) continue;
    const double share = std::clamp((p_lidar.norm() - kNear) / (kFar - kNear), 0.0, 1.0);
    const std::array<std::uint8_t, 3> color = {std::uint8_t(255 * (1 - share)),
                                               std::uint8_t(255 * 0.5 * share + 60),
                                               std::uint8_t(255 * share)};
    const int u = int(std::lround(pixel->x())), v = int(std::lround(pixel->y()));
    for (int y = std::max(0, v - reach); y <= std::min(picture.height - 1, v + reach); ++y) {
      for (int x = std::max(0, u - reach); x <= std::min(picture.width - 1, u + reach); ++x) {
        std::copy(color.begin(), color.end(),
                  picture.data.begin() + 3 * (std::ptrdiff_t(y) * picture.width + x));
      }
    }
  }
  return picture;
}

}  // namespace fovea
