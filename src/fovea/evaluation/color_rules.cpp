#include "fovea/evaluation/color_rules.h"

#include <algorithm>
#include <stdexcept>

#include "fovea/core/random.h"

namespace fovea {
namespace {

constexpr std::uint64_t kSeed = 1, kReservoir = 0x6d656469616eull;

std::array<float, 3> channels(Rgb color) {
  return {float(color.r), float(color.g), float(color.b)};
}

Rgb rounded(const std::array<float, 3>& color) {
  return to_rgb(Eigen::Vector3f(color[0], color[1], color[2]));
}

/// Vitter's algorithm R: after k views every one of them is in the sample with the same
/// probability.
void sample(ColorState& state, Rgb color, std::uint64_t point) {
  const std::uint32_t before = state.visible_views;
  if (before < ColorState::kSamples) {
    state.samples[before] = color;
    return;
  }
  Random random = Random::of_item(kSeed, kReservoir + before, point);
  const std::uint64_t place = random.below(before + 1);
  if (place < ColorState::kSamples) state.samples[place] = color;
}

/// R3LIVE, section "Rendering the texture of global map": the covariance of the colour grows by
/// sigma^2 dt since the last update, then both are fused by their inverse covariances. All
/// channels have the same variances, so that one number does.
void fuse(ColorState& state, const ColorObservation& seen) {
  const std::array<float, 3> color = channels(seen.color);
  constexpr float kObservation = kBayesObservation * kBayesObservation;
  if (state.visible_views == 0) {
    state.bayes = color;
    state.bayes_variance = kObservation;
  } else {
    const float prior =
        state.bayes_variance + kBayesWalk * kBayesWalk * (seen.time - state.bayes_time);
    const float gain = prior / (prior + kObservation);
    for (std::size_t c = 0; c < 3; ++c) state.bayes[c] += gain * (color[c] - state.bayes[c]);
    state.bayes_variance = gain * kObservation;
  }
  state.bayes_time = seen.time;
}

Rgb median(const ColorState& state) {
  const std::uint32_t count = std::min(state.visible_views, ColorState::kSamples);
  std::array<float, 3> middle{};
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<float, ColorState::kSamples> values;
    for (std::uint32_t i = 0; i < count; ++i) values[i] = channels(state.samples[i])[c];
    std::sort(values.begin(), values.begin() + count);
    middle[c] = 0.5f * (values[(count - 1) / 2] + values[count / 2]);
  }
  return rounded(middle);
}

}  // namespace

const char* to_string(ColorRule rule) {
  switch (rule) {
    case ColorRule::kFovea:
      return "fovea";
    case ColorRule::kLast:
      return "last";
    case ColorRule::kSingleView:
      return "single-view";
    case ColorRule::kNearest:
      return "nearest";
    case ColorRule::kBest:
      return "best";
    case ColorRule::kMean:
      return "mean";
    case ColorRule::kMedian:
      return "median";
    case ColorRule::kBayes:
      return "bayes";
    case ColorRule::kFloor:
      return "floor";
  }
  return "unknown";
}

void observe(ColorState& state, const ColorObservation& seen, std::uint64_t point) {
  if (state.views++ == 0) state.first = seen.color;
  state.last = seen.color;
  if (!seen.visible) return;
  if (seen.distance < state.nearest_distance) {
    state.nearest_distance = seen.distance;
    state.nearest = seen.color;
  }
  // The solid angle that a patch of the surface fills: the pixels that its texture got.
  const float weight = seen.cos_incidence / (seen.distance * seen.distance);
  if (weight > state.best_weight) {
    state.best_weight = weight;
    state.best = seen.color;
  }
  sample(state, seen.color, point);
  fuse(state, seen);
  ++state.visible_views;
  const std::array<float, 3> color = channels(seen.color);
  for (std::size_t c = 0; c < 3; ++c) {
    state.mean[c] += (color[c] - state.mean[c]) / static_cast<float>(state.visible_views);
  }
}

std::optional<Rgb> color_by(ColorRule rule, const ColorState& state) {
  const bool tests_occlusion = rule != ColorRule::kLast && rule != ColorRule::kSingleView;
  if ((tests_occlusion ? state.visible_views : state.views) == 0) return std::nullopt;
  switch (rule) {
    case ColorRule::kLast:
      return state.last;
    case ColorRule::kSingleView:
      return state.first;
    case ColorRule::kNearest:
      return state.nearest;
    case ColorRule::kBest:
      return state.best;
    case ColorRule::kMean:
      return rounded(state.mean);
    case ColorRule::kMedian:
      return median(state);
    case ColorRule::kBayes:
      return rounded(state.bayes);
    case ColorRule::kFovea:
    case ColorRule::kFloor:
      break;
  }
  throw std::invalid_argument("this rule needs more than a point's views");
}

}  // namespace fovea
