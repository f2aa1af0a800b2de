// Drives past upright boards, ray-cast, for tests of a camera's calibration.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/core/random.h"
#include "fovea/mapping/calibration/calibration_view.h"

namespace fovea::board_drive_test {

/// A rectangle of one gray value with a smooth texture: a post, a sign or a low wall. Some lean.
struct Board {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::UnitY(), up = Eigen::Vector3d::UnitZ();
  double half_width = 0, half_height = 0;
  double gray = 0, phase = 0;
};

/// Waves in three directions, between -1 and 1. The wavelengths are about 2 pi.
inline double texture(double a, double b, double phase) {
  return (std::sin(a + 0.3 * b + phase) + std::sin(0.6 * a - 0.8 * b + 2 * phase) +
          std::sin(1.2 * b - 0.2 * a + 3 * phase)) /
         3;
}

constexpr double kGround = -1.8, kWall = 60;  // m

/// Boards on both sides of a road, up to 33 m ahead.
inline std::vector<Board> boards_at_road() {
  Random random(5);
  std::vector<Board> boards;
  for (int i = 0; i < 26; ++i) {
    Board board;
    const double side = i % 2 == 0 ? 1 : -1;
    const double angle = random.uniform(-0.5, 0.5), lean = i % 3 == 2 ? 0.4 * side : 0;
    const Eigen::Vector3d level(std::sin(angle), std::cos(angle), 0);
    board.right = std::cos(lean) * level + std::sin(lean) * Eigen::Vector3d::UnitZ();
    board.up = std::cos(lean) * Eigen::Vector3d::UnitZ() - std::sin(lean) * level;
    board.half_width = i % 3 == 0 ? random.uniform(0.1, 0.25) : random.uniform(0.4, 1.2);
    board.half_height = random.uniform(0.4, 1.1);
    const double bottom = i % 4 == 1 ? random.uniform(0.8, 1.6) : 0;  // signs are above ground
    board.center = {5 + 1.1 * i + random.uniform(-0.5, 0.5), side * random.uniform(2.5, 9),
                    kGround + bottom + board.half_height};
    board.gray = i % 5 < 3 ? random.uniform(20, 70) : random.uniform(180, 230);
    board.phase = random.uniform(0, 6);
    boards.push_back(board);
  }
  return boards;
}

/// Boards in front of a ground and a far wall. x ahead, y left, z up; the LiDAR is at z = 0.
class BoardWorld {
 public:
  explicit BoardWorld(std::vector<Board> boards) : boards_(std::move(boards)) {}
  const std::vector<Board>& boards() const { return boards_; }

  struct Hit {
    double distance = std::numeric_limits<double>::infinity();  // in lengths of the direction
    double gray = 0;
  };
  /// @param candidates  the boards that the ray may meet
  Hit cast(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
           const std::vector<const Board*>& candidates) const {
    double best = (kWall - from.x()) / direction.x();
    if (!(best > 0)) best = std::numeric_limits<double>::infinity();
    const double to_ground = (kGround - from.z()) / direction.z();
    const bool is_ground = to_ground > 0 && to_ground < best;
    if (is_ground) best = to_ground;
    const Board* board = nullptr;
    for (const Board* candidate : candidates) {
      const Eigen::Vector3d normal = candidate->right.cross(candidate->up);
      const double distance = normal.dot(candidate->center - from) / normal.dot(direction);
      if (!(distance > 0 && distance < best)) continue;
      const Eigen::Vector3d offset = from + distance * direction - candidate->center;
      if (std::abs(candidate->up.dot(offset)) > candidate->half_height ||
          std::abs(candidate->right.dot(offset)) > candidate->half_width) {
        continue;
      }
      best = distance;
      board = candidate;
    }
    const Eigen::Vector3d p = from + best * direction;
    if (board != nullptr) {
      const double across = board->right.dot(p - board->center);
      return {best, board->gray + 30 * texture(6 * across, 6 * board->up.dot(p - board->center),
                                               board->phase)};
    }
    if (is_ground) {
      // A pixel is the mean over ever more ground: the texture fades.
      const double fade = 1 / (1 + (p - from).squaredNorm() / (20 * 20));
      return {best, 100 + 50 * fade * texture(2.5 * p.x(), 2.5 * p.y(), 1)};
    }
    return {best, 135 + 20 * texture(0.3 * p.y(), 0.4 * p.z(), 2)};
  }

 private:
  std::vector<Board> boards_;
};

/// How the LiDAR moves.
struct Route {
  double speed = 8;     // m/s
  double unsteady = 1;  // size of the changes of speed and direction; 0: straight and steady

  RigidMotion T_local_lidar(double t) const {
    RigidMotion T(Eigen::Translation3d(speed * t - unsteady * 2 * std::cos(2 * t),
                                       unsteady * 0.5 * std::sin(1.3 * t), 0));
    T.rotate(Eigen::AngleAxisd(unsteady * 0.15 * std::sin(1.9 * t), Eigen::Vector3d::UnitZ()));
    T.rotate(Eigen::AngleAxisd(unsteady * 0.01 * std::sin(5 * t), Eigen::Vector3d::UnitY()));
    return T;
  }
};

/// The true camera, as of a car at half the resolution of KITTI's.
inline Camera true_camera() {
  Camera camera;
  camera.width = 620;
  camera.height = 188;
  camera.fx = camera.fy = 360;
  camera.cx = 308;
  camera.cy = 90;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.translation() = Eigen::Vector3d(0.06, -0.08, -0.27);
  camera.image_delay = 0.012;
  return camera;
}

/// The camera as given, if `error` corrects it.
inline Camera given_camera(const CameraCorrection& error) {
  Camera camera = true_camera();
  const RigidMotion turn = exp_se3((Twist() << error.rotation, 0, 0, 0).finished());
  camera.T_cam_lidar =
      Eigen::Translation3d(-error.translation) * turn.inverse() * camera.T_cam_lidar;
  camera.image_delay -= error.delay;
  return camera;
}

/// @param radial  share by which the corner of the image lies farther out than the focal length
///                says; radial distortion
inline Image render(const BoardWorld& world, const Camera& camera, const RigidMotion& T_local_lidar,
                    double radial = 0) {
  constexpr int kSamples = 2;     // of a pixel, along each axis
  constexpr double kMargin = 20;  // pixels
  const RigidMotion T_cam_local = camera.T_cam_lidar * T_local_lidar.inverse();
  const RigidMotion T_local_cam = T_cam_local.inverse();
  std::vector<std::vector<const Board*>> columns(std::size_t(camera.width));
  for (const Board& board : world.boards()) {
    double first = camera.width, last = 0;
    for (const double side : {-1, 1}) {
      for (const double up : {-1, 1}) {
        const auto pixel =
            camera.project(T_cam_local * (board.center + side * board.half_width * board.right +
                                          up * board.half_height * board.up));
        first = std::min(first, pixel ? pixel->x() - kMargin : 0);
        last = std::max(last, pixel ? pixel->x() + kMargin : camera.width);
      }
    }
    for (int x = std::max(0, int(first)); x < std::min(camera.width, int(last)); ++x) {
      columns[std::size_t(x)].push_back(&board);
    }
  }
  const double corner = std::hypot(camera.width, camera.height) / 2;
  Image image(camera.width, camera.height, 1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const Eigen::Vector2d pixel((k % kSamples + 0.5) / kSamples - 0.5 + x - camera.cx,
                                    (k / kSamples + 0.5) / kSamples - 0.5 + y - camera.cy);
        Eigen::Vector2d ideal = pixel;
        for (int i = 0; i < 3 && radial != 0; ++i) {
          ideal = pixel / (1 + radial * ideal.squaredNorm() / (corner * corner));
        }
        const Eigen::Vector3d ray(ideal.x() / camera.fx, ideal.y() / camera.fy, 1);
        sum += world
                   .cast(T_local_cam.translation(), T_local_cam.linear() * ray,
                         columns[std::size_t(x)])
                   .gray;
      }
      image.pixel(x, y)[0] =
          static_cast<std::uint8_t>(std::clamp(sum / (kSamples * kSamples) + 0.5, 0.0, 255.0));
    }
  }
  return image;
}

/// 64 rings of 0.4 degrees, of a LiDAR that stands during the scan.
inline PointCloud scan(const BoardWorld& world, const RigidMotion& T_local_lidar) {
  constexpr int kRings = 64, kReach = 250;  // beams of 0.2 degrees to both sides
  std::vector<const Board*> all;
  for (const Board& board : world.boards()) all.push_back(&board);
  PointCloud points_lidar;
  for (int ring = 0; ring < kRings; ++ring) {
    const double elevation = (10.0 - 0.4 * ring) * kDegree;
    for (int step = kReach; step >= -kReach; --step) {
      const double azimuth = 0.2 * step * kDegree;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto hit = world.cast(T_local_lidar.translation(), T_local_lidar.linear() * beam, all);
      if (!std::isfinite(hit.distance)) continue;
      points_lidar.position.push_back((hit.distance * beam).cast<float>());
      points_lidar.ring.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  return points_lidar;
}

struct BoardDriveOptions {
  Route route;
  std::vector<Board> boards = boards_at_road();
  int views = 12;
  double radial = 0;  ///< see render()
};

struct BoardDrive {
  std::vector<CalibrationView> views;
  PoseSpline T_local_lidar{{}};
};

/// Scans and poses at 10 Hz, images of the true camera.
inline BoardDrive board_drive(const BoardDriveOptions& options = {}) {
  constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;
  constexpr double kStep = 0.1;     // s
  constexpr int kFurtherPoses = 4;  // before and after the views
  constexpr double kMaxRange = 40;
  constexpr std::size_t kSurfaceStep = 11;  // every N-th point
  const BoardWorld world(options.boards);
  const Camera camera = true_camera();
  BoardDrive drive;
  std::vector<StampedPose> poses;
  for (int i = -kFurtherPoses; i < options.views + kFurtherPoses; ++i) {
    const double time = kStep * i;
    const RigidMotion T_local_lidar = options.route.T_local_lidar(time);
    poses.push_back({kStart + from_seconds(time), T_local_lidar});
    if (i < 0 || i >= options.views) continue;
    CalibrationView view;
    view.frame = i;
    view.stamp = poses.back().time;
    view.image = render(world, camera, options.route.T_local_lidar(time + camera.image_delay),
                        options.radial);
    const PointCloud points_lidar = scan(world, T_local_lidar);
    view.edges_lidar = {find_lidar_edges(points_lidar, camera, kMaxRange)};
    for (std::size_t k = 0; k < points_lidar.size(); k += kSurfaceStep) {
      const Eigen::Vector3d p_cam = camera.T_cam_lidar * points_lidar.position[k].cast<double>();
      const auto pixel = camera.project(p_cam);
      if (!pixel || !camera.in_view(*pixel) || p_cam.norm() > kMaxRange) continue;
      view.surface_lidar.push_back(points_lidar.position[k]);
    }
    drive.views.push_back(std::move(view));
  }
  drive.T_local_lidar = PoseSpline(std::move(poses));
  return drive;
}

}  // namespace fovea::board_drive_test
