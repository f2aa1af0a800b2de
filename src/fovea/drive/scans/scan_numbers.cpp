#include "fovea/drive/scans/scan_numbers.h"

#include <algorithm>
#include <cmath>

#include "fovea/drive/scans/scan_columns.h"

namespace fovea {
namespace {

template <class T>
double quantile(std::vector<T>& values, double share) {
  const double place = share * double(values.size() - 1);
  const auto middle =
      values.begin() + std::ptrdiff_t(share < 0.5 ? std::floor(place) : std::ceil(place));
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

/// Whether hardly a number lies between two that are the ends of the middle half.
bool is_split(const std::vector<double>& values, double low, double high) {
  constexpr double kInner = 0.95, kFewest = 0.01;  // shares
  constexpr std::size_t kEnough = 20;
  const double middle = 0.5 * (low + high), reach = 0.5 * kInner * (high - low);
  const auto inner = std::count_if(values.begin(), values.end(),
                                   [&](double value) { return std::abs(value - middle) < reach; });
  return values.size() >= kEnough && high > low && double(inner) < kFewest * double(values.size());
}

}  // namespace

std::span<const char* const> ScanNumberRows::columns() const { return kScanColumns; }

const char* ScanNumberRows::description() const { return kScanDescription; }

void ScanNumberRows::describe(std::span<const std::string> names, bool /*organized*/) {
  numbers_.columns.assign(names.begin(), names.end());
}

void ScanNumberRows::begin(std::size_t points, std::span<const std::optional<Scalar>> types) {
  numbers_.whole_coordinates = !is_real(*types[kScanX]);
  has_times_ = types[kScanTime].has_value();
  whole_times_ = has_times_ && !is_real(*types[kScanTime]);
  ranges_.reserve(points);
  intensities_.reserve(points);
  if (has_times_) times_.reserve(points);
}

void ScanNumberRows::add(std::span<const double> row, std::size_t /*number*/) {
  constexpr double kFarthest = 1e9;  // any unit's; NaN fails, too
  const double range = std::hypot(row[kScanX], row[kScanY], row[kScanZ]);
  if (!(range > 0 && range < kFarthest)) return;
  ranges_.push_back(static_cast<float>(range));
  if (std::isfinite(row[kScanIntensity])) {
    intensities_.push_back(static_cast<float>(row[kScanIntensity]));
  }
  if (has_times_ && std::isfinite(row[kScanTime])) times_.push_back(row[kScanTime]);
}

ScanNumbers ScanNumberRows::take() {
  if (!ranges_.empty()) numbers_.median_range = quantile(ranges_, 0.5);
  numbers_.scale.add(intensities_);
  if (!intensities_.empty()) numbers_.median_intensity = quantile(intensities_, 0.5);
  if (!times_.empty()) {
    const double low = quantile(times_, 0.25), high = quantile(times_, 0.75);
    numbers_.times = RawTimes{0.5 * (low + high), 2 * (high - low), whole_times_,
                              is_split(times_, low, high), times_.size()};
  }
  return std::move(numbers_);
}

}  // namespace fovea
