#include "fovea/mapping/calibration/coarse_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"
#include "fovea/core/parallel.h"
#include "fovea/mapping/calibration/image_edge_map.h"

namespace fovea {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMaxEdges = 6000;
constexpr double kRotationReach = 6 * kDegree, kDelayReach = 0.12;  // rad, s
constexpr double kRotationStep = 1 * kDegree, kRollStep = 3 * kDegree, kRollReach = 6 * kDegree;
constexpr double kTranslationStep = 0.1;                      // m
constexpr double kPixelStep = 0.0175;                         // rad, median of a step of the delay
constexpr double kMinDelayStep = 0.01, kMaxDelayStep = 0.04;  // s
constexpr std::array<std::size_t, ImageEdgeMap::kLevels> kKept{64, 32, 16, 6};  // after each level
constexpr int kMaxSweeps = 30;
constexpr double kMaxRotation = 8 * kDegree, kMaxTranslation = 0.3, kMaxDelay = 0.16;  // rad, m, s

/// An edge of a scan and the direction across it in the image.
struct CoarseEdge {
  Eigen::Vector3f p_lidar;
  float upright = 0;  ///< 1: an upright edge, 0: a level one
};

struct CoarseView {
  const CalibrationView* view = nullptr;
  ImageEdgeMap map;
  std::vector<CoarseEdge> edges;
};

struct Candidate {
  CameraCorrection correction;
  double score = 0;
};

std::optional<CoarseEdge> coarse_edge(const LidarEdges& edges_lidar, std::size_t k,
                                      const Camera& camera) {
  const Vector3d inside = edges_lidar.inside.position[k].cast<double>(),
                 outside = edges_lidar.outside.position[k].cast<double>();
  const auto from = camera.project(camera.T_cam_lidar * inside);
  const auto to = camera.project(camera.T_cam_lidar * outside);
  if (!from || !to) return std::nullopt;
  const Eigen::Vector2d across = (*to - *from).normalized();
  return CoarseEdge{(0.5 * (inside + outside)).cast<float>(),
                    static_cast<float>(across.x() * across.x())};
}

/// The edges of all views and their agreement with the images.
class CoarseScore {
 public:
  CoarseScore(const std::vector<CalibrationView>& views, const Camera& camera,
              const PoseSpline& T_local_lidar);

  bool empty() const { return views_.empty(); }
  double at(int level, const CameraCorrection& correction) const;
  /// Median speed of edges in the images, rad/s.
  double flow() const;

 private:
  Camera camera_;
  const PoseSpline& T_local_lidar_;
  std::vector<CoarseView> views_;
};

CoarseScore::CoarseScore(const std::vector<CalibrationView>& views, const Camera& camera,
                         const PoseSpline& T_local_lidar)
    : camera_(camera), T_local_lidar_(T_local_lidar) {
  std::size_t count = 0;
  for (const CalibrationView& view : views) {
    for (const LidarEdges& edges_lidar : view.edges_lidar) count += edges_lidar.size();
  }
  const std::size_t stride = 1 + count / kMaxEdges;
  std::vector<std::optional<CoarseView>> made(views.size());
  parallel_for(views.size(), 1, [&](std::size_t i) {
    const CalibrationView& view = views[i];
    if (view.image.empty() || !image_moment(view, camera.image_delay, T_local_lidar)) return;
    CoarseView coarse{&view, ImageEdgeMap(view.image, camera.fx), {}};
    for (const LidarEdges& edges_lidar : view.edges_lidar) {
      for (std::size_t k = i % stride; k < edges_lidar.size(); k += stride) {
        if (const auto edge = coarse_edge(edges_lidar, k, camera)) coarse.edges.push_back(*edge);
      }
    }
    if (!coarse.edges.empty()) made[i] = std::move(coarse);
  });
  for (std::optional<CoarseView>& coarse : made) {
    if (coarse) views_.push_back(*std::move(coarse));
  }
}

double CoarseScore::at(int level, const CameraCorrection& correction) const {
  const Camera camera = corrected(camera_, correction);
  const auto fx = float(camera.fx), fy = float(camera.fy), cx = float(camera.cx),
             cy = float(camera.cy);
  double sum = 0;
  for (const CoarseView& view : views_) {
    const auto moment = image_moment(*view.view, camera.image_delay, T_local_lidar_);
    if (!moment) continue;
    const Eigen::Isometry3f T_cam_lidar =
        (camera.T_cam_lidar * moment->T_image_stamp).cast<float>();
    float sum_view = 0;
    for (const CoarseEdge& edge : view.edges) {
      const Eigen::Vector3f p = T_cam_lidar * edge.p_lidar;
      if (!(p.z() > float(Camera::kMinDepth))) continue;
      sum_view +=
          view.map.at(level, fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy, edge.upright);
    }
    sum += double(sum_view);
  }
  return sum;
}

double CoarseScore::flow() const {
  std::vector<double> speeds;
  for (const CoarseView& view : views_) {
    const auto moment = image_moment(*view.view, camera_.image_delay, T_local_lidar_);
    if (!moment) continue;
    for (const CoarseEdge& edge : view.edges) {
      const Vector3d p_lidar = moment->T_image_stamp * edge.p_lidar.cast<double>();
      const PixelJacobian J = pixel_jacobian(camera_, p_lidar, moment->velocity);
      speeds.push_back(J.col(kCamDelay).norm() / camera_.fx);
    }
  }
  return median_of(std::move(speeds));
}

/// Whether two corrections differ by less than a step in each parameter.
bool are_near(const CameraCorrection& a, const CameraCorrection& b,
              const CalibrationVector& steps) {
  const Vector3d turn = (a.rotation - b.rotation).cwiseAbs(),
                 shift = (a.translation - b.translation).cwiseAbs();
  return (turn.array() < 1.01 * steps.segment<3>(kCamRotation).array()).all() &&
         (shift.array() < 1.01 * steps.segment<3>(kCamTranslation).array()).all() &&
         std::abs(a.delay - b.delay) < 1.01 * steps[kCamDelay];
}

/// The best candidates, no two of which are near each other.
void keep_best(std::vector<Candidate>& candidates, std::size_t count,
               const CalibrationVector& steps) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    if (kept.size() == count) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return are_near(candidate.correction, other.correction, steps);
    });
    if (is_new) kept.push_back(candidate);
  }
  candidates = std::move(kept);
}

std::vector<double> grid(double reach, double step) {
  std::vector<double> values;
  const int steps = static_cast<int>(std::ceil(reach / step - 1e-9));
  for (int i = -steps; i <= steps; ++i) values.push_back(i * step);
  return values;
}

std::vector<Candidate> search_grid(const CoarseScore& score, double delay_step) {
  std::vector<Candidate> candidates;
  for (const double delay : grid(kDelayReach, delay_step)) {
    for (const double roll : grid(kRollReach, kRollStep)) {
      for (const double pitch : grid(kRotationReach, kRotationStep)) {
        for (const double yaw : grid(kRotationReach, kRotationStep)) {
          candidates.push_back({{.rotation = {pitch, yaw, roll}, .delay = delay}, 0});
        }
      }
    }
  }
  parallel_for(candidates.size(), 16,
               [&](std::size_t i) { candidates[i].score = score.at(0, candidates[i].correction); });
  return candidates;
}

bool is_in_reach(const CameraCorrection& correction) {
  return correction.rotation.cwiseAbs().maxCoeff() <= kMaxRotation &&
         correction.translation.norm() <= kMaxTranslation &&
         std::abs(correction.delay) <= kMaxDelay;
}

/// Steps along one parameter at a time as long as one of them raises the score.
Candidate climb(const CoarseScore& score, int level, Candidate candidate,
                const CalibrationVector& steps) {
  candidate.score = score.at(level, candidate.correction);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool better = false;
    for (int k = 0; k < kCalibrationSize; ++k) {
      for (const int sign : {-1, 1}) {
        Candidate next = candidate;
        const CalibrationVector step = sign * steps[k] * CalibrationVector::Unit(k);
        next.correction.rotation += step.segment<3>(kCamRotation);
        next.correction.translation += step.segment<3>(kCamTranslation);
        next.correction.delay += step[kCamDelay];
        if (!is_in_reach(next.correction)) continue;
        next.score = score.at(level, next.correction);
        if (!(next.score > candidate.score)) continue;
        candidate = next;
        better = true;
      }
    }
    if (!better) break;
  }
  return candidate;
}

}  // namespace

std::vector<CameraCorrection> coarse_corrections(const std::vector<CalibrationView>& views,
                                                 const Camera& camera,
                                                 const PoseSpline& T_local_lidar) {
  const CoarseScore score(views, camera, T_local_lidar);
  if (score.empty()) return {};
  const double flow = std::max(score.flow(), 1e-6);
  const double delay_step = std::clamp(kPixelStep / flow, kMinDelayStep, kMaxDelayStep);
  std::vector<Candidate> candidates = search_grid(score, delay_step);
  CalibrationVector steps = CalibrationVector::Zero();
  steps.segment<3>(kCamRotation) << kRotationStep, kRotationStep, kRollStep;
  steps.segment<3>(kCamTranslation).setConstant(kTranslationStep);
  steps[kCamDelay] = delay_step;
  keep_best(candidates, kKept[0], steps);
  for (int level = 1; level < ImageEdgeMap::kLevels; ++level) {
    steps /= 2;
    parallel_for(candidates.size(), 1,
                 [&](std::size_t i) { candidates[i] = climb(score, level, candidates[i], steps); });
    keep_best(candidates, kKept[std::size_t(level)], steps);
  }
  std::vector<CameraCorrection> corrections;
  corrections.reserve(candidates.size());
  for (const Candidate& candidate : candidates) corrections.push_back(candidate.correction);
  return corrections;
}

}  // namespace fovea
