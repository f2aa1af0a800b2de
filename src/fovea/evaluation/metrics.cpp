#include "fovea/evaluation/metrics.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/ciede2000.h"
#include "fovea/evaluation/cross_fit.h"

namespace fovea {
namespace {

/// Mean and standard deviation in two passes: one pass cancels where the spread is small.
std::pair<double, double> mean_and_deviation(const std::vector<float>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0;
  for (const float value : values) sum += value;
  const double mean = sum / n;
  double squares = 0;
  for (const float value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / n)};
}

double median(std::vector<float> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (static_cast<double>(*std::max_element(values.begin(), middle)) + *middle);
}

double share_up_to(const std::vector<float>& values, float bound) {
  const auto count =
      std::count_if(values.begin(), values.end(), [&](float value) { return value <= bound; });
  return static_cast<double>(count) / static_cast<double>(values.size());
}

}  // namespace

float color_error(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool grey) {
  return grey ? std::abs(truth.x() - luma(map)) : (truth - map).norm();
}

NearestSamples nearest_samples(const std::vector<Eigen::Vector3f>& positions, const KdTree& tree,
                               std::span<const LogColor> color,
                               std::span<const std::uint8_t> interpolated,
                               std::span<const std::uint8_t> left_out) {
  constexpr std::size_t kGrain = 2048;
  NearestSamples found{std::vector<float>(positions.size()),
                       std::vector<Eigen::Vector3f>(positions.size()),
                       std::vector<std::uint8_t>(interpolated.empty() ? 0 : positions.size()),
                       std::vector<std::uint32_t>(positions.size())};
  parallel_for(positions.size(), kGrain, [&](std::size_t i) {
    const KdTree::Neighbor nearest = left_out.empty()
                                         ? tree.nearest(positions[i])
                                         : tree.nearest_unmarked(positions[i], left_out);
    found.distance[i] = std::sqrt(nearest.squared_distance);
    found.color[i] = to_float(color[nearest.index]);
    found.index[i] = static_cast<std::uint32_t>(nearest.index);
    if (!interpolated.empty()) found.interpolated[i] = interpolated[nearest.index];
  });
  return found;
}

void GainFit::add(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool grey) {
  const Eigen::Array3d c = truth.cast<double>();
  const Eigen::Array3d n =
      grey ? Eigen::Array3d::Constant(luma(map)).eval() : Eigen::Array3d(map.cast<double>());
  products_ += c * n;
  squares_ += n * n;
}

Eigen::Vector3f GainFit::gains() const {
  return (squares_ > 0).select(products_ / squares_, 1.0).cast<float>();
}

Eigen::Vector3f fit_gains(const std::vector<Eigen::Vector3f>& truth,
                          const std::vector<Eigen::Vector3f>& map, bool grey) {
  GainFit fit;
  for (std::size_t i = 0; i < truth.size(); ++i) fit.add(truth[i], map[i], grey);
  return fit.gains();
}

void PointErrors::append(const PointErrors& other) {
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(position, other.position);
  add(color, other.color);
  add(color_gain, other.color_gain);
  add(ciede2000, other.ciede2000);
  add(interpolated, other.interpolated);
  add(color_cross, other.color_cross);
  add(log_cross, other.log_cross);
  add(square_cross, other.square_cross);
  add(color_predicted, other.color_predicted);
}

PointErrors PointErrors::select(const std::vector<std::uint8_t>& marks, std::uint8_t wanted) const {
  PointErrors selected;
  const auto take = [&](auto& to, const auto& from) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (marks[i] == wanted) to.push_back(from[i]);
    }
  };
  take(selected.position, position);
  take(selected.color, color);
  take(selected.color_gain, color_gain);
  take(selected.ciede2000, ciede2000);
  take(selected.interpolated, interpolated);
  take(selected.color_cross, color_cross);
  take(selected.log_cross, log_cross);
  take(selected.square_cross, square_cross);
  take(selected.color_predicted, color_predicted);
  return selected;
}

PointErrors point_errors(const EvaluatedView& view, const NearestSamples& map,
                         const Eigen::Vector3f& gains,
                         const std::vector<Eigen::Vector3f>& predicted_colors) {
  PointErrors errors;
  errors.position = map.distance;
  errors.color.reserve(map.color.size());
  errors.color_gain.reserve(map.color.size());
  errors.ciede2000.reserve(map.color.size());
  errors.interpolated = map.interpolated;
  for (std::size_t i = 0; i < map.color.size(); ++i) {
    errors.color.push_back(color_error(view.color[i], map.color[i], view.grey));
    errors.color_gain.push_back(
        color_error(view.color[i], map.color[i].cwiseProduct(gains), view.grey));
    const Eigen::Vector3f seen =
        view.grey ? Eigen::Vector3f::Constant(luma(map.color[i])) : map.color[i];
    errors.ciede2000.push_back(static_cast<float>(ciede2000(lab_of(view.color[i]), lab_of(seen))));
  }
  const std::vector<Eigen::Vector3f> fitted = cross_fitted(view, map.color);
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    errors.color_cross.push_back(color_error(view.color[i], fitted[i], view.grey));
    errors.log_cross.push_back(log_color_error(view.color[i], fitted[i], view.grey));
    errors.square_cross.push_back((view.color[i] - fitted[i]).squaredNorm() / 3);
  }
  for (std::size_t i = 0; i < predicted_colors.size(); ++i) {
    errors.color_predicted.push_back(color_error(view.color[i], predicted_colors[i], view.grey));
  }
  return errors;
}

ErrorFigures summarize(const PointErrors& errors) {
  if (errors.position.empty()) return {};
  ErrorFigures figures;
  figures.points = errors.position.size();
  std::tie(figures.me_mean, figures.me_std) = mean_and_deviation(errors.position);
  figures.coverage_5cm = share_up_to(errors.position, kCoverageFine);
  figures.coverage_20cm = share_up_to(errors.position, kCoverageCoarse);
  if (errors.color.empty()) return figures;
  std::tie(figures.te_mean, figures.te_std) = mean_and_deviation(errors.color);
  figures.te_median = median(errors.color);
  figures.te_within_20 = share_up_to(errors.color, kColorWithin);
  figures.te_percent = 100 * figures.te_mean / 255;
  figures.te_gain_mean = mean_and_deviation(errors.color_gain).first;
  figures.te_gain_within_20 = share_up_to(errors.color_gain, kColorWithin);
  if (!errors.color_cross.empty()) {
    figures.te_cross_mean = mean_and_deviation(errors.color_cross).first;
    figures.te_cross_within_20 = share_up_to(errors.color_cross, kColorWithin);
    figures.log_cross_mean = mean_and_deviation(errors.log_cross).first;
    figures.psnr_cross =
        10 * std::log10(255.0 * 255.0 / mean_and_deviation(errors.square_cross).first);
  }
  if (errors.color_predicted.size() == figures.points) {
    figures.te_predicted_mean = mean_and_deviation(errors.color_predicted).first;
    figures.te_predicted_within_20 = share_up_to(errors.color_predicted, kColorWithin);
  }
  if (!errors.ciede2000.empty()) {
    figures.te_ciede2000_mean = mean_and_deviation(errors.ciede2000).first;
    figures.te_ciede2000_median = median(errors.ciede2000);
  }
  if (!errors.interpolated.empty()) {
    const auto made = std::count(errors.interpolated.begin(), errors.interpolated.end(), 1);
    figures.share_interpolated =
        static_cast<double>(made) / static_cast<double>(errors.interpolated.size());
  }
  double product = 0;
  for (std::size_t i = 0; i < errors.position.size(); ++i) {
    product += static_cast<double>(errors.position[i]) * errors.color[i];
  }
  figures.mtme = product / static_cast<double>(figures.points);
  return figures;
}

}  // namespace fovea
