#include "app/html_report/scan_pair.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "app/html_report/markup.h"
#include "fovea/core/angle.h"
#include "fovea/evaluation/scan_matching.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/ground.h"
#include "fovea/mapping/registration/registration.h"
#include "fovea/pipeline/motion_model.h"
#include "fovea/pipeline/registration_check.h"
#include "fovea/upsample.h"

namespace fovea::app {
namespace {

constexpr float kWindow = 3;  // m, of the close view
constexpr int kPixels = 420;  // 7 mm each
constexpr Rgb kTargetColor{63, 183, 255}, kSourceColor{255, 154, 61};

/// Two neighbouring frames and where the second is guessed to be.
struct Pair {
  PlacedFrame target, source;
  RigidMotion guess_T_local_lidar;
  double error = 0;  ///< m, of the guess against the map's pose
};

/// What the mapper would guess; empty where a frame has no time or nothing is known.
std::optional<RigidMotion> guess(const FrameSource& drive, const PlacedFrame* before,
                                 const PlacedFrame& target, const PlacedFrame& source) {
  const DriveInfo& info = drive.info();
  const auto target_time = drive.stamp(target.index), source_time = drive.stamp(source.index);
  if (!target_time || !source_time) return std::nullopt;
  MotionModel motion(info.navigation ? &*info.navigation : nullptr, {.doubt = false});
  const auto before_time = before != nullptr ? drive.stamp(before->index) : std::nullopt;
  if (before_time) motion.update(*before_time, before->T_local_lidar);
  if (!before_time && !info.navigation) return std::nullopt;
  motion.update(*target_time, target.T_local_lidar);
  return motion.predict(*source_time).guesses.front().T_odom_lidar;
}

/// Of pairs whose frames follow each other, the one that is guessed worst.
std::optional<Pair> choose_pair(const FrameSource& drive, const std::vector<PlacedFrame>& frames) {
  const DriveInfo& info = drive.info();
  std::optional<Pair> worst;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const PlacedFrame &target = frames[i - 1], &source = frames[i];
    if (source.index != target.index + 1) continue;
    if (target.index < info.begin || source.index >= info.end) continue;
    const auto guessed = guess(drive, i >= 2 ? &frames[i - 2] : nullptr, target, source);
    if (!guessed) continue;
    const double error = (guessed->inverse() * source.T_local_lidar).translation().norm();
    if (!worst || error > worst->error) worst = Pair{target, source, *guessed, error};
  }
  return worst;
}

/// What is drawn: the matched points in the first camera's view, upsampled, in the LiDAR's frame.
std::vector<Eigen::Vector3f> drawn_points(const PointCloud& scan_lidar, const Camera& camera,
                                          int rate) {
  PointCloud points;
  points.position = matched_points(scan_lidar, {camera});
  return transform_cloud(upsample(transform_cloud(points, camera.T_cam_lidar), camera,
                                  UpsampleOptions{.rate = rate}),
                         camera.T_cam_lidar.inverse())
      .position;
}

std::vector<Eigen::Vector3f> moved(std::vector<Eigen::Vector3f> points, const RigidMotion& T) {
  const Eigen::Isometry3f motion = T.cast<float>();
  for (Eigen::Vector3f& p : points) p = motion * p;
  return points;
}

/// What the points of a cell of the ground say of windows around it.
struct Cell {
  double points = 0, distance = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Cell& operator+=(const Cell& other) {
    points += other.points;
    distance += other.distance;
    sum += other.sum;
    squares += other.squares;
    return *this;
  }
  /// Distance between the scans times the smaller spread: a corner shows errors in both
  /// directions, a wall along the road in one.
  double interest() const {
    const Eigen::Matrix2d covariance = squares / points - sum * sum.transpose() / (points * points);
    const double spread =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues().x();
    return distance * std::sqrt(std::max(0.0, spread));
  }
};

/// The close view: where the guess leaves most to be seen between the scans.
Window choose_window(const std::vector<Eigen::Vector3f>& target,
                     const std::vector<Eigen::Vector3f>& source_in_target) {
  constexpr float kSame = 0.5f;  // m: farther neighbours are other surfaces
  constexpr float kStep = 0.5f;  // m
  const KdTree tree(target);
  std::map<std::pair<int, int>, Cell> cells;
  for (const Eigen::Vector3f& p : source_in_target) {
    const KdTree::Neighbor nearest = tree.nearest(p, kSame);
    if (!(nearest.squared_distance < kSame * kSame)) continue;
    const Eigen::Vector2d q = p.head<2>().cast<double>();
    cells[{int(std::floor(p.x() / kStep)), int(std::floor(p.y() / kStep))}] +=
        Cell{1, std::sqrt(nearest.squared_distance), q, q * q.transpose()};
  }
  Window best{{10, 0}, kWindow / kPixels, kPixels, kPixels};
  double most = 0;
  constexpr int kHalf = int(kWindow / kStep) / 2;
  for (const auto& [at, unused] : cells) {
    Cell window;
    for (int x = at.first - kHalf; x < at.first + kHalf; ++x) {
      for (int y = at.second - kHalf; y < at.second + kHalf; ++y) {
        const auto found = cells.find({x, y});
        if (found != cells.end()) window += found->second;
      }
    }
    if (window.interest() > most) {
      most = window.interest();
      best.center = kStep * Eigen::Vector2f(float(at.first), float(at.second));
    }
  }
  return best;
}

std::string distance(const ScanMatching& matching) {
  return std::isfinite(matching.mean) ? fmt::format("{:.2f} cm", 100 * matching.mean) : "none";
}

/// Both frames and what of them does not depend on the rate.
struct Scans {
  TrainingFrame target, source;
  std::vector<Eigen::Vector3f> target_matched, source_matched;
  RigidMotion T_target_guess;
  Window window;
};

/// Both scans as guessed, with the close view framed.
std::string overview(const Scans& scans) {
  const Window wide{{20, 0}, 0.04f, 1200, 400};
  Image image =
      draw_pair(scans.target_matched, moved(scans.source_matched, scans.T_target_guess), wide);
  const Eigen::Vector2f at = (scans.window.center - wide.center) / wide.pixel;
  const int half = static_cast<int>(0.5f * kWindow / wide.pixel);
  const int u = wide.width / 2 + static_cast<int>(at.x());
  const int v = wide.height / 2 - static_cast<int>(at.y());
  for (int y = v - half; y <= v + half; ++y) {
    for (int x = u - half; x <= u + half; ++x) {
      const bool border = std::max(std::abs(x - u), std::abs(y - v)) >= half - 1;
      if (!border || x < 0 || y < 0 || x >= wide.width || y >= wide.height) continue;
      std::fill_n(image.pixel(x, y), 3, std::uint8_t{200});
    }
  }
  return fmt::format(
      "<figure class=\"overview\"><img alt=\"Both scans from above\" src=\"{}\"/><figcaption>Both "
      "scans as guessed, {:g} m wide, ahead to the right. Framed: the close view "
      "below.</figcaption></figure>\n",
      png_uri(image), wide.pixel * float(wide.width));
}

const RegistrationOptions kRegistration{.method = RegistrationMethod::kGicp};

/// As the paper's mapper registers a scan (E0 to E3).
RegistrationCloud points_to_register(const PointCloud& scan_lidar,
                                     const std::vector<Camera>& cameras, int rate) {
  GroundOptions ground;
  ground.sensor_height = sensor_height(scan_lidar.position).value_or(kUsualSensorHeight);
  return prepare_cloud(upsample_non_ground(scan_lidar, segment_ground(scan_lidar.position, ground),
                                           cameras, {.rate = rate}),
                       kRegistration);
}

std::string rate_figure(const Scans& scans, const std::vector<Camera>& cameras, int rate) {
  const RegistrationCloud target = points_to_register(scans.target.scan_lidar, cameras, rate);
  const RegistrationCloud source = points_to_register(scans.source.scan_lidar, cameras, rate);
  const RegistrationResult registered_pair = register_clouds(
      target, PointIndex(target.points), source, scans.T_target_guess, kRegistration);
  const RigidMotion found = scans.T_target_guess.inverse() * registered_pair.T_target_source;
  const std::string failure = failure_of(registered_pair, alignment_stats(registered_pair, found));
  const RigidMotion correction = failure.empty() ? found : RigidMotion::Identity();
  const RigidMotion T_target_source = scans.T_target_guess * correction;

  const auto a = drawn_points(scans.target.scan_lidar, cameras.front(), rate);
  const auto b = drawn_points(scans.source.scan_lidar, cameras.front(), rate);
  const Image before = draw_pair(a, moved(b, scans.T_target_guess), scans.window);
  const Image after = draw_pair(a, moved(b, T_target_source), scans.window);
  const ScanMatching guessed =
      match_scans(scans.source_matched, scans.target_matched, scans.T_target_guess);
  const ScanMatching registered =
      match_scans(scans.source_matched, scans.target_matched, T_target_source);
  const std::string remark =
      failure.empty() ? std::string() : fmt::format(" {}.", escaped(failure));
  return fmt::format(
      "<figure class=\"scans\"><img alt=\"The scans as guessed, rate {0}\" src=\"{1}\"/>"
      "<img alt=\"The scans as registered, rate {0}\" src=\"{2}\"/><figcaption><b>Rate {0}</b>: "
      "{3} "
      "points of the second scan. Scan-matching error <b>{4}</b> before, <b>{5}</b> after; moved "
      "by "
      "{6:.1f} cm and {7:.2f}&#176;.{8}</figcaption></figure>\n",
      rate, png_uri(before), png_uri(after), count(b.size()), distance(guessed),
      distance(registered), 100 * correction.translation().norm(),
      rotation_angle(correction.linear()) / kDegree, remark);
}

}  // namespace

Image draw_pair(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b,
                const Window& window) {
  const int width = window.width, height = window.height;
  std::vector<std::uint8_t> layers(static_cast<std::size_t>(width) * height, 0);
  const auto put = [&](const std::vector<Eigen::Vector3f>& points, std::uint8_t layer) {
    for (const Eigen::Vector3f& p : points) {
      const Eigen::Vector2f at = (p.head<2>() - window.center) / window.pixel;
      const float left = 0.5f * float(width) + at.x(), top = 0.5f * float(height) - at.y();
      if (!(left >= 0 && top >= 0 && left < float(width) && top < float(height))) continue;
      const int u = int(left), v = int(top);
      for (int y = v; y < std::min(v + 2, height); ++y) {
        for (int x = u; x < std::min(u + 2, width); ++x) {
          layers[static_cast<std::size_t>(y) * width + x] |= layer;
        }
      }
    }
  };
  put(a, 1);
  put(b, 2);
  constexpr std::array<Rgb, 4> kColors{Rgb{7, 8, 10}, kTargetColor, kSourceColor,
                                       Rgb{255, 255, 255}};
  Image image(width, height, 3);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Rgb color = kColors[layers[i]];
    image.data[3 * i] = color.r;
    image.data[3 * i + 1] = color.g;
    image.data[3 * i + 2] = color.b;
  }
  return image;
}

std::string scan_pair_section(const FrameSource& drive, const std::vector<PlacedFrame>& training) {
  const std::vector<Camera>& cameras = drive.info().calibration.cameras;
  const std::optional<Pair> pair = choose_pair(drive, training);
  if (!pair) return excuse("No two mapped scans follow each other with a guess of their motion.");
  auto target = load_frame(drive, pair->target), source = load_frame(drive, pair->source);
  if (!target || !source) return excuse("The scans could not be loaded again.");
  Scans scans{std::move(*target), std::move(*source), {}, {}, {}, {}};
  scans.target_matched = matched_points(scans.target.scan_lidar, cameras);
  scans.source_matched = matched_points(scans.source.scan_lidar, cameras);
  if (scans.target_matched.empty() || scans.source_matched.empty()) {
    return excuse("The scans show no point above the ground in the cameras' view.");
  }
  scans.T_target_guess = pair->target.T_local_lidar.inverse() * pair->guess_T_local_lidar;
  scans.window =
      choose_window(scans.target_matched, moved(scans.source_matched, scans.T_target_guess));
  std::string html = fmt::format(
      "<p>Frames <span class=\"dot-a\">{}</span> and <span class=\"dot-b\">{}</span> from above, "
      "without ground, where both agree white: the pair that {} places worst ({:.1f} cm off the "
      "map's poses). Above as guessed, below as registered to the scan before by generalised ICP, "
      "at "
      "each rate of upsampling (the paper's E0 to E3). The close "
      "view is {:g} m wide; the "
      "scan-matching "
      "error counts measured points only.</p>\n{}<div class=\"strip\">\n",
      pair->target.index, pair->source.index,
      drive.info().navigation ? "the navigation" : "constant velocity", 100 * pair->error, kWindow,
      overview(scans));
  for (int rate = 0; rate < kPairRates; ++rate) html += rate_figure(scans, cameras, rate);
  return html + "</div>\n";
}

}  // namespace fovea::app
