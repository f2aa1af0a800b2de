#include "fovea/mapping/calibration/color_consistency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "fovea/core/median.h"
#include "fovea/core/parallel.h"
#include "fovea/mapping/calibration/gray_plane.h"
#include "fovea/mapping/calibration/grouped_scatter.h"

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t kNeighbors = 3;                   // later views that a view is compared with
constexpr double kMinBaseline = 0.3, kMaxBaseline = 6;  // m
constexpr TimeNs kLongestStep = 5 * kNsPerSecond;       // a pause may be between the views
constexpr std::size_t kMaxPoints = 1500;                // of a pair
constexpr double kMinDepth = 2, kMaxDepth = 40;         // m
constexpr int kBorder = 8;                              // pixels
constexpr float kDark = 10;          // gray values, added so that noise in the dark is small
constexpr double kNeighborhood = 5;  // standard deviation of the neighborhood, in that of the blur
constexpr double kStep = 0.5;        // of the differences, in the blur
constexpr double kReach = 2;         // of a maximum, in these steps
constexpr double kMadToSigma = 1.4826;

/// Logarithm of an image's brightness, smoothed, less that of the neighborhood: exposure,
/// vignetting and reflections change slowly over an image and drop out.
class LogImage {
 public:
  LogImage(const Image& image, double blur);
  bool is_inside(const Vector2d& pixel) const {
    return pixel.x() >= kBorder && pixel.y() >= kBorder && pixel.x() < width_ - kBorder &&
           pixel.y() < height_ - kBorder;
  }
  /// Bilinear, at the nearest pixel inside.
  double at(double u, double v) const {
    u = std::clamp(u, 0.0, width_ - 1.001);
    v = std::clamp(v, 0.0, height_ - 1.001);
    const auto x = static_cast<int>(u), y = static_cast<int>(v);
    const double a = u - x, b = v - y;
    return (1 - b) * ((1 - a) * value(x, y) + a * value(x + 1, y)) +
           b * ((1 - a) * value(x, y + 1) + a * value(x + 1, y + 1));
  }

 private:
  double value(int x, int y) const { return double(plane_.at(x, y)); }

  int width_, height_;
  GrayPlane plane_;
};

LogImage::LogImage(const Image& image, double blur) : width_(image.width), height_(image.height) {
  GrayPlane log = gray_plane(image);
  for (float& value : log.values) value = std::log(value + kDark);
  plane_ = smoothed(std::move(log), blur);
  const GrayPlane neighborhood = smoothed(plane_, kNeighborhood * blur);
  for (std::size_t i = 0; i < plane_.values.size(); ++i) {
    plane_.values[i] -= neighborhood.values[i];
  }
}

struct ReadyView {
  const CalibrationView* view = nullptr;
  ImageMoment moment;
  std::optional<LogImage> image;
};

/// A surface point in the images of two views.
struct Comparison {
  std::uint32_t first, second;  // views
  Vector3d p_local;
  std::array<int, 3> place;
  int pair;
};

/// Derivatives of the log likelihood of a comparison.
struct ColorGradient {
  const Comparison* comparison;
  CalibrationVector value = CalibrationVector::Zero();
};

using Pair = std::pair<std::size_t, std::size_t>;

std::vector<Pair> pairs_of(const std::vector<std::optional<ReadyView>>& views) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::size_t count = 0;
    for (std::size_t j = i + 1; j < views.size() && count < kNeighbors; ++j) {
      if (!views[i] || !views[j]) continue;
      const double baseline = (views[i]->moment.T_local_lidar.translation() -
                               views[j]->moment.T_local_lidar.translation())
                                  .norm();
      if (baseline < kMinBaseline) continue;
      const TimeNs elapsed = views[j]->view->stamp - views[i]->view->stamp;
      if (baseline > kMaxBaseline || elapsed > kLongestStep) break;
      pairs.emplace_back(i, j);
      ++count;
    }
  }
  return pairs;
}

bool is_visible(const ReadyView& view, const Camera& camera, const Vector3d& p_local) {
  const Vector3d p_cam = camera.T_cam_lidar * (view.moment.T_local_lidar.inverse() * p_local);
  if (p_cam.z() < kMinDepth || p_cam.z() > kMaxDepth) return false;
  const auto pixel = camera.project(p_cam);
  return pixel && view.image->is_inside(*pixel) && !view.view->is_masked(*pixel);
}

std::vector<Comparison> comparisons_of(const std::vector<std::optional<ReadyView>>& views,
                                       const Pair& views_of_pair, const Camera& camera, int pair) {
  const auto [i, j] = views_of_pair;
  const ReadyView& first = *views[i];
  const std::vector<Eigen::Vector3f>& points = first.view->surface_lidar;
  const RigidMotion T_local_stamp = first.moment.T_local_lidar * first.moment.T_image_stamp;
  const std::size_t stride = 1 + points.size() / kMaxPoints;
  std::vector<Comparison> comparisons;
  for (std::size_t k = std::size_t(pair) % stride; k < points.size(); k += stride) {
    const Vector3d p_local = T_local_stamp * points[k].cast<double>();
    if (!is_visible(first, camera, p_local) || !is_visible(*views[j], camera, p_local)) continue;
    comparisons.push_back(
        {std::uint32_t(i), std::uint32_t(j), p_local, object_cell(p_local), pair});
  }
  return comparisons;
}

/// Differences of the colors of the same points under any calibration near the one at hand.
class ColorDifferences {
 public:
  ColorDifferences(const std::vector<CalibrationView>& views, const Camera& camera,
                   const PoseSpline& T_local_lidar, double blur);
  const std::vector<Comparison>& comparisons() const { return comparisons_; }
  /// @param x  in calibration_unit()s
  std::vector<double> at(const CalibrationVector& x) const;

 private:
  Camera camera_;
  const PoseSpline& T_local_lidar_;
  std::vector<std::optional<ReadyView>> views_;
  std::vector<Comparison> comparisons_;
};

ColorDifferences::ColorDifferences(const std::vector<CalibrationView>& views, const Camera& camera,
                                   const PoseSpline& T_local_lidar, double blur)
    : camera_(camera), T_local_lidar_(T_local_lidar), views_(views.size()) {
  parallel_for(views.size(), 1, [&](std::size_t i) {
    const auto moment = image_moment(views[i], camera.image_delay, T_local_lidar);
    if (!moment || views[i].image.empty()) return;
    views_[i] = ReadyView{&views[i], *moment, LogImage(views[i].image, blur)};
  });
  const std::vector<Pair> pairs = pairs_of(views_);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto of_pair = comparisons_of(views_, pairs[k], camera, int(k));
    comparisons_.insert(comparisons_.end(), of_pair.begin(), of_pair.end());
  }
}

std::vector<double> ColorDifferences::at(const CalibrationVector& x) const {
  const Camera camera = corrected(camera_, correction_of(x));
  std::vector<RigidMotion> T_cam_local(views_.size());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (!views_[i]) continue;
    const auto moment = image_moment(*views_[i]->view, camera.image_delay, T_local_lidar_);
    const RigidMotion& T_local_image =
        moment ? moment->T_local_lidar : views_[i]->moment.T_local_lidar;
    T_cam_local[i] = camera.T_cam_lidar * T_local_image.inverse();
  }
  std::vector<double> differences(comparisons_.size());
  parallel_for(comparisons_.size(), 4096, [&](std::size_t k) {
    const Comparison& c = comparisons_[k];
    const auto value = [&](std::uint32_t view) {
      const Vector3d p = T_cam_local[view] * c.p_local;
      return views_[view]->image->at(camera.fx * p.x() / p.z() + camera.cx,
                                     camera.fy * p.y() / p.z() + camera.cy);
    };
    differences[k] = value(c.second) - value(c.first);
  });
  return differences;
}

/// Log likelihood of a difference (Cauchy).
double likelihood(double difference, double sigma) {
  return -std::log1p(difference * difference / (sigma * sigma));
}

/// Drops the directions in which the colors show no maximum within reach: there the second
/// differences are noise, and a Newton step would lead anywhere.
void keep_maxima(QuadraticTerm& term, double reach) {
  const Eigen::SelfAdjointEigenSolver<CalibrationMatrix> eigen(term.curvature);
  CalibrationMatrix kept = CalibrationMatrix::Zero();  // projection
  CalibrationMatrix curvature = CalibrationMatrix::Zero();
  for (int k = 0; k < eigen.eigenvalues().size(); ++k) {
    const CalibrationVector direction = eigen.eigenvectors().col(k);
    const double bend = eigen.eigenvalues()[k];
    if (!(bend > 0) || std::abs(direction.dot(term.gradient)) > reach * bend) continue;
    const CalibrationMatrix projection = direction * direction.transpose();
    kept += projection;
    curvature += bend * projection;
  }
  term.curvature = curvature;
  term.gradient = CalibrationVector(kept * term.gradient);
  term.scatter = CalibrationMatrix(kept * term.scatter * kept);
}

/// Gradients of each comparison and curvature of the sum, by differences. Image derivatives are not
/// used, since the two images show a point at different resolutions.
QuadraticTerm term_of(const ColorDifferences& colors, double sigma, double step) {
  const std::size_t count = colors.comparisons().size();
  const auto likelihoods = [&](const CalibrationVector& x) {
    std::vector<double> values = colors.at(step * x);
    for (double& value : values) value = likelihood(value, sigma);
    return values;
  };
  const auto total = [&](const CalibrationVector& x) {
    double sum = 0;
    for (const double value : likelihoods(x)) sum += value;
    return sum;
  };
  const double middle = total(CalibrationVector::Zero());
  std::vector<ColorGradient> gradients;
  gradients.reserve(count);
  for (const Comparison& comparison : colors.comparisons()) gradients.push_back({&comparison});
  Eigen::Matrix<double, kCalibrationSize, 1> bend;
  for (int k = 0; k < kCalibrationSize; ++k) {
    const auto up = likelihoods(CalibrationVector::Unit(k));
    const auto down = likelihoods(-CalibrationVector::Unit(k));
    bend[k] = -2 * middle;
    for (std::size_t i = 0; i < count; ++i) {
      gradients[i].value[k] = (up[i] - down[i]) / (2 * step);
      bend[k] += up[i] + down[i];
    }
  }
  QuadraticTerm term;
  for (const ColorGradient& gradient : gradients) term.gradient += gradient.value;
  for (int k = 0; k < kCalibrationSize; ++k) {
    term.curvature(k, k) = -bend[k] / (step * step);
    for (int l = 0; l < k; ++l) {
      const CalibrationVector both = CalibrationVector::Unit(k) + CalibrationVector::Unit(l);
      const double bend_both = total(both) + total(-both) - 2 * middle;
      term.curvature(k, l) = term.curvature(l, k) =
          -(bend_both - bend[k] - bend[l]) / (2 * step * step);
    }
  }
  const auto value = [](const ColorGradient& g) { return g.value; };
  term.scatter =
      grouped_scatter(gradients, value, [](const ColorGradient& g) { return g.comparison->pair; }) +
      grouped_scatter(gradients, value, [](const ColorGradient& g) { return g.comparison->place; });
  keep_maxima(term, kReach * step);
  return term;
}

}  // namespace

ColorConsistency color_consistency(const std::vector<CalibrationView>& views, const Camera& camera,
                                   const PoseSpline& T_local_lidar, double blur) {
  const ColorDifferences colors(views, camera, T_local_lidar, blur);
  ColorConsistency result;
  result.comparisons = colors.comparisons().size();
  if (result.comparisons == 0) return result;
  std::vector<double> sizes = colors.at(CalibrationVector::Zero());
  for (double& size : sizes) size = std::abs(size);
  result.difference = median_of(std::move(sizes));
  const double sigma = std::max(1e-6, kMadToSigma * result.difference);
  result.term = term_of(colors, sigma, kStep * blur);
  return result;
}

}  // namespace fovea
