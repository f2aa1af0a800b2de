#include "fovea/ray_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::int32_t kMapOwner = -1;
constexpr float kNoRay = std::numeric_limits<float>::infinity();
// docs/method.md 5, step 2: minimum deviations, for windows of equal rays.
constexpr double kFlatSigma = 1e-3;   // m
constexpr double kFlatOffset = 1e-2;  // m
constexpr std::size_t kGrain = 4096;

struct Pixel {
  int x, y;
};

Pixel pixel_of(const Ray& ray) {
  return {static_cast<int>(std::floor(ray.pixel.x() + 0.5f)),
          static_cast<int>(std::floor(ray.pixel.y() + 0.5f))};
}

/// Running mean and deviation about a reference length, for precision.
struct WindowStatistics {
  int count = 0;
  double sum = 0, square = 0;
  void add(double offset) {
    ++count;
    sum += offset;
    square += offset * offset;
  }
  // Eq. 1, relative to d_i: mean() is mu - d_i.
  double mean() const { return sum / count; }
  double sigma() const { return std::sqrt(std::max(0.0, square / count - mean() * mean())); }
};

}  // namespace

void RayFilter::assign_owners(std::span<const Ray> scan, std::span<const Ray> map,
                              const Camera& camera) {
  owners_.assign(static_cast<std::size_t>(camera.width) * camera.height,
                 {kNoRay, kMapOwner, false});
  const auto owner_at = [&](const Ray& ray) -> Owner& {
    const Pixel p = pixel_of(ray);
    return owners_[static_cast<std::size_t>(p.y) * camera.width + p.x];
  };
  for (const Ray& ray : map) {
    Owner& owner = owner_at(ray);
    owner.length = std::min(owner.length, ray.length);
    owner.map_point = true;
  }
  for (std::size_t i = 0; i < scan.size(); ++i) {
    Owner& owner = owner_at(scan[i]);
    if (scan[i].length < owner.length) {
      owner.length = scan[i].length;
      owner.scan_index = static_cast<std::int32_t>(i);
    }
  }
}

std::vector<RayVerdict> RayFilter::filter(std::span<const Ray> scan, std::span<const Ray> map,
                                          const Camera& camera, const RayFilterOptions& options) {
  std::vector<RayVerdict> verdicts(scan.size(), RayVerdict::kVisible);
  assign_owners(scan, map, camera);

  const int half = options.window / 2;
  const auto judge = [&](std::size_t i) {
    const Pixel p = pixel_of(scan[i]);
    const Owner& own = owners_[static_cast<std::size_t>(p.y) * camera.width + p.x];
    const bool is_owner = own.scan_index == static_cast<std::int32_t>(i);
    if (!is_owner && own.scan_index != kMapOwner) return RayVerdict::kShared;
    if (is_owner && own.map_point) return RayVerdict::kOccluding;

    WindowStatistics window;
    const int x_end = std::min(camera.width - 1, p.x + half);
    const int y_end = std::min(camera.height - 1, p.y + half);
    for (int y = std::max(0, p.y - half); y <= y_end; ++y) {
      const Owner* row = owners_.data() + static_cast<std::size_t>(y) * camera.width;
      for (int x = std::max(0, p.x - half); x <= x_end; ++x) {
        if (row[x].length != kNoRay) window.add(row[x].length - scan[i].length);
      }
    }
    // Eq. 2: |d_i - mu| <= c sigma. Our addition: a flat window.
    const double offset = std::abs(window.mean()), sigma = window.sigma();
    const bool visible =
        offset <= options.outlier_rate * sigma || (sigma < kFlatSigma && offset < kFlatOffset);
    return visible ? RayVerdict::kVisible : RayVerdict::kOccluded;
  };
  parallel_for(scan.size(), kGrain, [&](std::size_t i) { verdicts[i] = judge(i); });
  return verdicts;
}

}  // namespace fovea
