#include "fovea/mapping/view_colors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/mapping/projected_block.h"

namespace fovea {
namespace {

constexpr float kWeightAtOneMeter = 1600;
/// Share of the weight of a view that a saturated or black value keeps. It counts where the point
/// has no other view.
constexpr float kLeastShare = 1.0f / 64;

/// How far a value can be trusted, 0 to 1: noise dominates dark values, bright ones are cut off.
float trust(float darkest, float brightest) {
  constexpr float kNoisy = 16, kNearlySaturated = 236;
  const float above_noise = darkest / kNoisy;
  const float below_saturation =
      (kSaturatedValue - brightest) / (kSaturatedValue - kNearlySaturated);
  return std::clamp(std::min(above_noise, below_saturation), kLeastShare, 1.0f);
}

/// Replaces gray values by color codes.
/// @param values  a row of a ColorBlock
void to_codes(std::span<float> values) {
  constexpr float kLeastValue = 0.5f;  // half a gray value: a black pixel
  constexpr float kCodesPerE = float(kColorCodesPerStop) * std::numbers::log2e_v<float>;
  Eigen::Map<Eigen::ArrayXf, EIGEN_MAX_ALIGN_BYTES> codes(values.data(),
                                                          Eigen::Index(values.size()));
  codes = float(kColorCodeOfOne) + kCodesPerE * codes.max(kLeastValue).log();
}

/// Replaces the gray values of a channel by color codes in the exposure of the map.
/// @param vignetting, gain  stops
void to_map_codes(std::span<float> values, std::span<const float> vignetting, float gain,
                  float offset) {
  if (offset == 0) {
    to_codes(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] -= (gain + vignetting[i]) * float(kColorCodesPerStop);
    }
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = (values[i] + offset) * std::exp2(-(gain + vignetting[i])) - offset;
  }
  to_codes(values);
}

}  // namespace

std::uint16_t view_weight(float distance) {
  return static_cast<std::uint16_t>(
      std::clamp(kWeightAtOneMeter / distance, 1.0f, kWeightAtOneMeter) + 0.5f);
}

ViewColors::ViewColors(const ImagePyramid& image, const Camera& camera, double footprint,
                       const ImageMask* mask)
    : image_(image),
      footprint_(static_cast<float>(footprint * camera.fx)),
      fx_(static_cast<float>(camera.fx)),
      fy_(static_cast<float>(camera.fy)),
      cx_(static_cast<float>(camera.cx)),
      cy_(static_cast<float>(camera.cy)),
      s_per_pixel_(squared_distance_from_center(camera, {camera.cx + 1, camera.cy})),
      mask_(mask) {}

ViewColors ViewColors::in_light(const ViewLight& light) const {
  ViewColors view = *this;
  view.light_ = light;
  return view;
}

void ViewColors::sample(const ProjectedPoints& points, std::size_t count, Samples& samples) const {
  std::array<float, ProjectedPoints::kSize> footprint;
  for (std::size_t i = 0; i < count; ++i) footprint[i] = footprint_ / points.depth[i];
  ColorBlock values;
  image_.colors_at({points.u.data(), count}, {points.v.data(), count}, {footprint.data(), count},
                   values);
  std::array<float, ProjectedPoints::kSize> vignetting;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Array3f value(values.red[i], values.green[i], values.blue[i]);
    const float x = points.u[i] - cx_, y = points.v[i] - cy_;
    const float right = x / fx_, down = y / fy_;
    const float distance = points.depth[i] * std::sqrt(1 + right * right + down * down);
    vignetting[i] = light_.response.vignetting_at((x * x + y * y) * s_per_pixel_);
    ColorSample& sample = samples[i];
    sample.weight = static_cast<std::uint16_t>(
        std::max(1.0f, float(view_weight(distance)) * trust(value.minCoeff(), value.maxCoeff())));
    // A mean reaches over three footprints at most (ImagePyramid::colors_at), and a pixel beyond.
    const float half = 1.5f * footprint[i] + 1;
    if (mask_ != nullptr && mask_->covers(points.u[i], points.v[i], half)) sample.weight = 0;
    sample.saturated = 0;
    for (int c = 0; c < 3; ++c) {
      if (value[c] >= kSaturatedValue) sample.saturated |= static_cast<std::uint8_t>(1 << c);
    }
  }
  const std::array channels{values.red.data(), values.green.data(), values.blue.data()};
  for (int c = 0; c < 3; ++c) {
    const std::span<float> channel(channels[std::size_t(c)], count);
    to_map_codes(channel, vignetting, light_.gain[c], static_cast<float>(light_.response.offset));
    for (std::size_t i = 0; i < count; ++i) samples[i].code[c] = channel[i];
  }
}

std::vector<FusedColor> first_colors(std::span<const Eigen::Vector3f> points_cam,
                                     const ViewColors& view, const Camera& camera,
                                     const DepthBuffer* depth, const LogGain& submap_gain) {
  std::vector<FusedColor> colors(points_cam.size());
  parallel_chunks(colors.size(), ProjectedPoints::kSize, [&](std::size_t begin, std::size_t end) {
    ProjectedBlock block(camera);
    block.project(points_cam.subspan(begin, end - begin), Eigen::Matrix3f::Identity(),
                  Eigen::Vector3f::Zero());
    ProjectedPoints projected;
    for (std::size_t i = 0; i < end - begin; ++i) {
      projected.put(i, block.pixel(i), block.depth(i));
    }
    ViewColors::Samples samples;
    view.sample(projected, end - begin, samples);
    for (std::size_t i = 0; i < end - begin; ++i) {
      if (samples[i].weight == 0) continue;
      samples[i].code -= float(kColorCodesPerStop) * submap_gain;
      if (depth != nullptr && depth->is_doubtful(block.pixel(i))) samples[i].trust_less();
      fuse(samples[i], /*random=*/0, colors[begin + i]);
    }
  });
  return colors;
}

void color_new_points(PointCloud& points_cam, const ViewColors& view, const Camera& camera,
                      const DepthBuffer* depth, int frame, const LogGain& submap_gain) {
  const std::size_t n = points_cam.size();
  points_cam.frame.assign(n, frame);
  for (const FusedColor& color :
       first_colors(points_cam.position, view, camera, depth, submap_gain)) {
    points_cam.camera.push_back(color.views == 0 ? kNoCamera
                                                 : static_cast<std::int8_t>(camera.index));
    points_cam.color.push_back(color.color);
    points_cam.views.push_back(color.views);
    points_cam.spread.push_back(color.spread);
    points_cam.weight.push_back(color.weight);
    points_cam.saturated.push_back(color.saturated);
  }
}

}  // namespace fovea
