#include "fovea/mapping/response_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fovea/mapping/radiometry.h"

namespace fovea {
namespace {

constexpr float kWindow = 0.047f;  // stops, 3.2 %
/// Constants of sRGB and BT.709, of values up to 255.
constexpr double kOffsetOfSrgb = 255 * 0.055, kOffsetOfBt709 = 255 * 0.099;
/// What a pair counts after the next one. The weights of the first pairs follow from poor
/// estimates.
constexpr double kMemory = 0.98, kMemoryOfFirst = 0.9;
constexpr std::size_t kFirstPairs = 20;
/// Errors are alike in the channels of a point, and of neighbors.
constexpr double kCorrelated = 6;
constexpr double kDeviations = 3;           // standard deviations that count as certain
constexpr double kVignettingKnown = 0.022;  // stops, 1.5 %
constexpr double kOffsetMatters = 0.043;    // stops, 3 %

/// Stops by which the gains of dark (32) and bright (192) values differ for one stop of exposure.
double deviation_from_power_law(double offset) {
  const auto gain = [&](double value) { return std::log2((2 * value + offset) / value); };
  return std::abs(gain(32) - gain(192));
}

Eigen::Vector3d powers(double s) { return {s, s * s, s * s * s}; }

/// The points whose two values noise could not make dark or saturated. They are chosen by the mean
/// of both: a limit for each would favor points whose noise goes one way.
std::vector<SharedPoint> well_exposed(const std::vector<SharedPoint>& points, int channel) {
  std::vector<float> ratios;
  ratios.reserve(points.size());
  for (const SharedPoint& point : points) {
    ratios.push_back(std::log2(point.second.value[channel] / point.first.value[channel]));
  }
  const float half_gain = std::abs(mode_of(ratios, kWindow).value) / 2;
  const float least = std::log2(kDarkValue) + half_gain + kExposureMargin;
  const float most = std::log2(kSaturatedValue) - half_gain - kExposureMargin;
  std::vector<SharedPoint> chosen;
  for (const SharedPoint& point : points) {
    const float mean =
        (std::log2(point.first.value[channel]) + std::log2(point.second.value[channel])) / 2;
    if (mean > least && mean < most) chosen.push_back(point);
  }
  return chosen;
}

}  // namespace

ResponseFit::ResponseFit() {
  curves_[1].offset = kOffsetOfSrgb;
  curves_[2].offset = kOffsetOfBt709;
}

void ResponseFit::Curve::forget(double memory) {
  squares *= memory;
  weights *= memory;
  information *= memory;
  right_side *= memory;
}

void ResponseFit::Curve::add(const std::vector<SharedPoint>& points, int channel) {
  struct Sample {
    Coefficients derivative;
    double difference;  // stops, second image minus first
    double mean;        // of both values
    double by_offset;   // derivative of the difference
  };
  std::vector<Sample> samples;
  std::vector<float> errors;
  for (const SharedPoint& point : points) {
    const double first = double(point.first.value[channel]) + offset;
    const double second = double(point.second.value[channel]) + offset;
    samples.push_back({powers(double(point.second.squared_distance)) -
                           powers(double(point.first.squared_distance)),
                       std::log2(second / first), std::sqrt(first * second), 0});
    errors.push_back(float(samples.back().difference - samples.back().derivative.dot(vignetting)));
  }
  const Mode mode = mode_of(errors, kWindow);
  // Of the two values as the gain makes them from their mean: the difference of the measured ones
  // would correlate with their noise.
  const double half_gain = std::exp2(double(mode.value) / 2);
  std::vector<double> weight;
  double sum = 0;
  Sample mean{Coefficients::Zero(), 0, 0, 0};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].by_offset = (1 / half_gain - half_gain) / samples[i].mean / std::log(2.0);
    weight.push_back(biweight(double(errors[i]), mode));
    sum += weight[i];
    mean.derivative += weight[i] * samples[i].derivative;
    mean.difference += weight[i] * samples[i].difference;
    mean.by_offset += weight[i] * samples[i].by_offset;
  }
  mean.derivative /= sum;
  mean.difference /= sum;
  mean.by_offset /= sum;
  // The gain is free: deviations from the means count.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Coefficients derivative = samples[i].derivative - mean.derivative;
    const double difference = samples[i].difference - mean.difference;
    const double by_offset = samples[i].by_offset - mean.by_offset;
    information += weight[i] * derivative * derivative.transpose();
    right_side += weight[i] * difference * derivative;
    const double error = difference - derivative.dot(vignetting);
    squares += weight[i] * error * error;
    offset_information += weight[i] * by_offset * by_offset;
    offset_right_side -= weight[i] * error * by_offset;
  }
  weights += sum;
}

double ResponseFit::Curve::variance() const {
  return kCorrelated * squares / std::max(weights, 1.0);
}

double ResponseFit::Curve::offset_error() const {
  return offset_right_side / std::max(offset_information, 1e-12);
}

void ResponseFit::add(const std::vector<SharedPoint>& points) {
  constexpr std::size_t kLeastPoints = 50;
  if (points.size() < kLeastPoints) return;
  std::vector<float> distances;
  distances.reserve(points.size());
  for (const SharedPoint& point : points) distances.push_back(point.second.squared_distance);
  const auto far = distances.begin() + std::ptrdiff_t(distances.size() * 9 / 10);
  std::nth_element(distances.begin(), far, distances.end());
  far_distances_ += double(*far);
  ++pairs_;
  std::array<std::vector<SharedPoint>, 3> chosen;
  for (std::size_t c = 0; c < 3; ++c) chosen[c] = well_exposed(points, int(c));
  for (Curve& curve : curves_) {
    curve.forget(pairs_ <= kFirstPairs ? kMemoryOfFirst : kMemory);
    for (std::size_t c = 0; c < 3; ++c) {
      if (chosen[c].size() >= kLeastPoints) curve.add(chosen[c], int(c));
    }
    const auto& solved = solve(curve).response.vignetting;
    curve.vignetting = {solved[0], solved[1], solved[2]};
  }
}

ResponseFit::Solution ResponseFit::solve(const Curve& curve) {
  Solution best;
  best.response.offset = curve.offset;
  double most = 0;  // the fall of the squared errors
  for (int subset = 1; subset < 8; ++subset) {
    std::vector<int> free;
    for (int k = 0; k < 3; ++k) {
      if ((subset >> k & 1) != 0) free.push_back(k);
    }
    Eigen::MatrixXd information = curve.information(free, free);
    information.diagonal().array() += 1e-9;
    const Eigen::MatrixXd inverse = information.inverse();
    const Eigen::VectorXd right_side = curve.right_side(free);
    const Eigen::VectorXd values = inverse * right_side;
    if (values.maxCoeff() > 0 || right_side.dot(values) <= most) continue;
    most = right_side.dot(values);
    best.response.vignetting = {};
    best.covariance.setZero();
    for (std::size_t k = 0; k < free.size(); ++k) {
      best.response.vignetting[std::size_t(free[k])] = values[Eigen::Index(k)];
    }
    best.covariance(free, free) = curve.variance() * inverse;
  }
  return best;
}

const ResponseFit::Curve& ResponseFit::best_curve() const {
  const Curve& power_law = curves_[0];
  const double deviation =
      std::sqrt(power_law.variance() / std::max(power_law.offset_information, 1e-12));
  const double least = power_law.offset_error() - kDeviations * deviation;
  if (least <= 0 || deviation_from_power_law(least) < kOffsetMatters) return power_law;
  return *std::min_element(curves_.begin(), curves_.end(), [](const Curve& a, const Curve& b) {
    return std::abs(a.offset_error()) < std::abs(b.offset_error());
  });
}

bool ResponseFit::is_vignetting(const Solution& solution) const {
  const double s = far_distances_ / double(pairs_);
  const double deviation = std::sqrt(powers(s).dot(solution.covariance * powers(s)));
  return deviation < kVignettingKnown &&
         double(solution.response.vignetting_at(float(s))) < -kDeviations * deviation;
}

CameraResponse ResponseFit::response() const {
  if (pairs_ == 0) return {};
  const Solution solution = solve(best_curve());
  return is_vignetting(solution) ? solution.response : CameraResponse{solution.response.offset, {}};
}

}  // namespace fovea
