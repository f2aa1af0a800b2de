#include "fovea/evaluation/consistency.h"

#include <atomic>
#include <cmath>

#include "fovea/evaluation/evaluated_set.h"
#include "fovea/evaluation/metrics.h"
#include "fovea/mapping/radiometry.h"

namespace fovea {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double luma_at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return image.channels == 1 ? double(p[0]) : double(luma(Eigen::Vector3f(p[0], p[1], p[2])));
}

/// Variance of luma in the patch whose upper left pixel is (left, top).
double patch_variance(const Image& image, int left, int top) {
  constexpr int kPatch = RoughnessSums::kPatch;
  double sum = 0, squares = 0;
  for (int y = top; y < top + kPatch; ++y) {
    for (int x = left; x < left + kPatch; ++x) {
      const double value = luma_at(image, x, y);
      sum += value;
      squares += value * value;
    }
  }
  const double mean = sum / (kPatch * kPatch);
  return std::max(0.0, squares / (kPatch * kPatch) - mean * mean);
}

bool patch_covered(const SplatView& drawn, int left, int top) {
  for (int y = top; y < top + RoughnessSums::kPatch; ++y) {
    const auto row = drawn.covered.begin() + std::ptrdiff_t{y} * drawn.image.width + left;
    if (std::find(row, row + RoughnessSums::kPatch, 0) != row + RoughnessSums::kPatch) return false;
  }
  return true;
}

template <class Sum>
void add(Sum& sum, Sum value) {
  std::atomic_ref<Sum>(sum).fetch_add(value, std::memory_order_relaxed);
}

/// Color codes of a pixel; nothing if a channel is saturated or noise.
std::optional<Eigen::Array3i> codes_at(const Image& photograph, int x, int y) {
  const std::uint8_t* pixel = photograph.pixel(x, y);
  Eigen::Array3i codes;
  for (int c = 0; c < 3; ++c) {
    const std::uint8_t value = pixel[photograph.channels == 1 ? 0 : c];
    if (value < kDarkValue || value >= kSaturatedValue) return std::nullopt;
    codes[c] = codes_of_bytes()[value];
  }
  return codes;
}

/// Of a gray view the luma counts.
Eigen::Array3i own_codes(LogColor color, bool gray) {
  if (!gray) return codes_of(color).cast<int>();
  return Eigen::Array3i::Constant(color_code(double(luma(to_float(color)))));
}

}  // namespace

RoughnessSums& RoughnessSums::operator+=(const RoughnessSums& other) {
  patches += other.patches;
  excess += other.excess;
  return *this;
}

double RoughnessSums::roughness() const {
  return patches == 0 ? kNone : std::sqrt(std::max(0.0, excess / static_cast<double>(patches)));
}

RoughnessSums compare_roughness(const SplatView& drawn, const Image& photograph) {
  constexpr int kPatch = RoughnessSums::kPatch;
  RoughnessSums sums;
  for (int top = 0; top + kPatch <= photograph.height; top += kPatch) {
    for (int left = 0; left + kPatch <= photograph.width; left += kPatch) {
      if (!patch_covered(drawn, left, top)) continue;
      const double photo = patch_variance(photograph, left, top);
      if (photo > RoughnessSums::kSmooth * RoughnessSums::kSmooth) continue;
      ++sums.patches;
      sums.excess += patch_variance(drawn.image, left, top) - photo;
    }
  }
  return sums;
}

CrossViewTest::CrossViewTest(const ColoredPoints& map)
    : map_(map), sums_((map.position.size() + kStride - 1) / kStride) {}

void CrossViewTest::add_view(const SplatView& drawn, const Camera& camera,
                             const RigidMotion& T_cam_local, const Image& photograph,
                             const Eigen::Vector3f& gains) {
  const Eigen::Array3i gain_codes =
      (gains.array().max(1e-6f).log2() * kColorCodesPerStop).round().cast<int>();
  const RigidMotion T_cam_map = T_cam_local * Eigen::Translation3d(map_.origin);
  const Eigen::Vector3f center = T_cam_map.inverse().translation().cast<float>();
  for (const PointRun& run : map_.runs) {
    if (run.distance_to(center) > 2 * kEvaluatedFar) continue;  // the view's corners at most
    for (std::size_t i = (run.begin + kStride - 1) / kStride * kStride; i < run.end; i += kStride) {
      const Eigen::Vector3d p_cam = T_cam_map * map_.position[i].cast<double>();
      const std::optional<Eigen::Vector2d> pixel = scored_pixel(camera, p_cam);
      if (!pixel) continue;
      const int x = static_cast<int>(std::lround(pixel->x()));
      const int y = static_cast<int>(std::lround(pixel->y()));
      const std::size_t place = static_cast<std::size_t>(y) * photograph.width + x;
      if (drawn.covered[place] == 0 || p_cam.z() > 0.05 + 1.02 * drawn.depth[place]) continue;
      const std::optional<Eigen::Array3i> seen = codes_at(photograph, x, y);
      if (!seen) continue;
      const Eigen::Array3i in_map = *seen - gain_codes;
      const Eigen::Array3i error = in_map - own_codes(map_.color[i], photograph.channels == 1);
      Sums& sums = sums_[i / kStride];
      add(sums.views, 1);
      for (int c = 0; c < 3; ++c) add(sums.codes[std::size_t(c)], in_map[c]);
      add(sums.squares, std::int64_t{in_map.square().sum()});
      add(sums.errors, std::int64_t{error.square().sum()});
    }
  }
}

CrossViewTest::Result CrossViewTest::result() const {
  Result result;
  for (const Sums& sums : sums_) {
    if (sums.views < 2) continue;
    ++result.points;
    const auto n = static_cast<double>(sums.views);
    const Eigen::Array3d mean =
        Eigen::Array3d(double(sums.codes[0]), double(sums.codes[1]), double(sums.codes[2])) / n;
    result.map += static_cast<double>(sums.errors) / n;
    result.floor += static_cast<double>(sums.squares) / n - mean.square().sum();
  }
  const auto values = static_cast<double>(3 * result.points);
  const double per_code = std::log(2.0) / kColorCodesPerStop;
  result.map = result.points == 0 ? kNone : per_code * std::sqrt(result.map / values);
  result.floor =
      result.points == 0 ? kNone : per_code * std::sqrt(std::max(0.0, result.floor / values));
  return result;
}

}  // namespace fovea
