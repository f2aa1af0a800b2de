#include "fovea/evaluation/picture_quality.h"

#include <cmath>
#include <stdexcept>

#include "fovea/evaluation/metrics.h"

namespace fovea {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kHalf = 5;  // of the SSIM window
using Plane = std::vector<float>;

void require_same_size(const SplatView& drawn, const Image& photograph) {
  if (photograph.width != drawn.image.width || photograph.height != drawn.image.height) {
    throw std::invalid_argument("the drawn map and the photograph differ in size");
  }
}

Plane luma_plane(const Image& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  Plane plane(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* p = image.data.data() + i * image.channels;
    plane[i] =
        image.channels == 1 ? static_cast<float>(p[0]) : luma(Eigen::Vector3f(p[0], p[1], p[2]));
  }
  return plane;
}

std::array<float, kHalf + 1> gaussian() {
  std::array<float, kHalf + 1> weights{};
  float sum = 0;
  for (int i = 0; i <= kHalf; ++i) {
    weights[i] = std::exp(-float(i * i) / (2 * 1.5f * 1.5f));
    sum += i == 0 ? weights[i] : 2 * weights[i];
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

/// Gaussian sums, what lies outside counting nothing.
Plane blurred(const Plane& plane, int width, int height) {
  static const std::array<float, kHalf + 1> weights = gaussian();
  Plane rows(plane.size(), 0), both(plane.size(), 0);
  for (int y = 0; y < height; ++y) {
    const float* in = plane.data() + static_cast<std::size_t>(y) * width;
    float* out = rows.data() + static_cast<std::size_t>(y) * width;
    for (int k = -kHalf; k <= kHalf; ++k) {
      const float weight = weights[std::abs(k)];
      const int begin = std::max(0, -k), end = std::min(width, width - k);
      for (int x = begin; x < end; ++x) out[x] += weight * in[x + k];
    }
  }
  for (int y = 0; y < height; ++y) {
    float* out = both.data() + static_cast<std::size_t>(y) * width;
    for (int k = std::max(-kHalf, -y); k <= std::min(kHalf, height - 1 - y); ++k) {
      const float weight = weights[std::abs(k)];
      const float* in = rows.data() + static_cast<std::size_t>(y + k) * width;
      for (int x = 0; x < width; ++x) out[x] += weight * in[x];
    }
  }
  return both;
}

/// Sum of the similarities at the pixels where `mask` is 1, windows weighing these only.
double ssim_sum(const Plane& a, const Plane& b, const Plane& mask, int width, int height) {
  constexpr float kC1 = 0.01f * 255 * 0.01f * 255, kC2 = 0.03f * 255 * 0.03f * 255;
  const auto moment = [&](auto&& value) {
    Plane plane(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) plane[i] = mask[i] * value(a[i], b[i]);
    return blurred(plane, width, height);
  };
  const Plane weight = moment([](float, float) { return 1.0f; });
  const Plane first = moment([](float x, float) { return x; });
  const Plane second = moment([](float, float y) { return y; });
  const Plane first_squared = moment([](float x, float) { return x * x; });
  const Plane second_squared = moment([](float, float y) { return y * y; });
  const Plane product = moment([](float x, float y) { return x * y; });
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (mask[i] == 0) continue;
    const float w = 1 / weight[i];
    const float mx = first[i] * w, my = second[i] * w;
    const float vx = first_squared[i] * w - mx * mx, vy = second_squared[i] * w - my * my;
    const float cov = product[i] * w - mx * my;
    sum += (2 * mx * my + kC1) * (2 * cov + kC2) / ((mx * mx + my * my + kC1) * (vx + vy + kC2));
  }
  return sum;
}

double squared_error(const Image& drawn, const Image& photograph, std::size_t pixel) {
  const std::uint8_t* map = drawn.data.data() + 3 * pixel;
  const std::uint8_t* photo = photograph.data.data() + photograph.channels * pixel;
  if (photograph.channels == 1) {
    const double difference = luma(Eigen::Vector3f(map[0], map[1], map[2])) - double(photo[0]);
    return difference * difference;
  }
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double difference = double(map[c]) - double(photo[c]);
    sum += difference * difference;
  }
  return sum / 3;
}

double mean(double sum, std::size_t count) {
  return count == 0 ? kNone : sum / static_cast<double>(count);
}

double psnr(double sum, std::size_t count) {
  return 10 * std::log10(255.0 * 255.0 / mean(sum, count));
}

}  // namespace

PictureSums& PictureSums::operator+=(const PictureSums& other) {
  pixels += other.pixels;
  covered += other.covered;
  squared_all += other.squared_all;
  squared_covered += other.squared_covered;
  ssim_all += other.ssim_all;
  ssim_covered += other.ssim_covered;
  return *this;
}

double PictureSums::share_covered() const { return mean(static_cast<double>(covered), pixels); }
double PictureSums::psnr_all() const { return psnr(squared_all, pixels); }
double PictureSums::psnr_covered() const { return psnr(squared_covered, covered); }
double PictureSums::mean_ssim_all() const { return mean(ssim_all, pixels); }
double PictureSums::mean_ssim_covered() const { return mean(ssim_covered, covered); }

PictureSums compare_pictures(const SplatView& drawn, const Image& photograph) {
  require_same_size(drawn, photograph);
  const int width = photograph.width, height = photograph.height;
  PictureSums sums;
  sums.pixels = drawn.covered.size();
  Plane covered(sums.pixels);
  for (std::size_t i = 0; i < sums.pixels; ++i) {
    const double squared = squared_error(drawn.image, photograph, i);
    covered[i] = drawn.covered[i];
    sums.squared_all += squared;
    if (drawn.covered[i] == 0) continue;
    ++sums.covered;
    sums.squared_covered += squared;
  }
  const Plane map = luma_plane(drawn.image), photo = luma_plane(photograph);
  sums.ssim_all = ssim_sum(map, photo, Plane(sums.pixels, 1.0f), width, height);
  sums.ssim_covered = ssim_sum(map, photo, covered, width, height);
  return sums;
}

ShiftSums& ShiftSums::operator+=(const ShiftSums& other) {
  pixels += other.pixels;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] += other.difference[i];
  return *this;
}

double ShiftSums::at(const Eigen::Vector2i& shift) const {
  return difference[static_cast<std::size_t>((shift.y() + kReach) * kSide + shift.x() + kReach)];
}

Eigen::Vector2i ShiftSums::best() const {
  Eigen::Vector2i best = Eigen::Vector2i::Zero();
  if (pixels == 0) return best;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const Eigen::Vector2i shift(dx, dy);
      if (at(shift) < at(best) ||
          (at(shift) == at(best) && shift.squaredNorm() < best.squaredNorm())) {
        best = shift;
      }
    }
  }
  return best;
}

ShiftSums compare_shifts(const SplatView& drawn, const Image& photograph) {
  require_same_size(drawn, photograph);
  constexpr int kStep = 3, kReach = ShiftSums::kReach;
  const int width = photograph.width, height = photograph.height;
  const Plane map = luma_plane(drawn.image), photo = luma_plane(photograph);
  ShiftSums sums;
  for (int y = kReach; y + kReach < height; y += kStep) {
    for (int x = kReach; x + kReach < width; x += kStep) {
      const std::size_t here = static_cast<std::size_t>(y) * width + x;
      if (drawn.covered[here] == 0) continue;
      ++sums.pixels;
      double* out = sums.difference.data();
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const float* row = photo.data() + here + std::ptrdiff_t{dy} * width - kReach;
        for (int dx = 0; dx < ShiftSums::kSide; ++dx) *out++ += std::abs(row[dx] - map[here]);
      }
    }
  }
  return sums;
}

}  // namespace fovea
