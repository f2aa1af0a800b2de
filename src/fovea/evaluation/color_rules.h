// Colour rules: how a map's point gets one colour from all views that look at it (docs/method.md
// 7). Points, poses and views are the same for all of them; only the rule differs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "fovea/image.h"

namespace fovea {

enum class ColorRule {
  kFovea,       ///< as the map has it
  kLast,        ///< the last view; no occlusion test
  kSingleView,  ///< the first view; no occlusion test
  kNearest,     ///< the view from the smallest distance
  kBest,        ///< the view with the greatest cos(incidence) / distance^2
  kMean,        ///< mean of all views
  kMedian,      ///< per channel, of at most 15 views
  kBayes,       ///< recursive estimate whose certainty fades with time (R3LIVE)
  kFloor,       ///< ORACLE: for each held-out point the training view nearest to its colour
};
inline constexpr std::array<ColorRule, 9> kColorRules = {
    ColorRule::kFovea,   ColorRule::kLast,  ColorRule::kSingleView,
    ColorRule::kNearest, ColorRule::kBest,  ColorRule::kMean,
    ColorRule::kMedian,  ColorRule::kBayes, ColorRule::kFloor};
/// "fovea", "last", "single-view", "nearest", "best", "mean", "median", "bayes", "floor".
const char* to_string(ColorRule rule);

/// What one view says of a point that projects into it.
struct ColorObservation {
  Rgb color;                ///< interpolated at its pixel
  float distance = 0;       ///< m, from the camera
  float cos_incidence = 1;  ///< of the angle between view ray and normal, 0-1; 1 where unknown
  float time = 0;           ///< s, of the view; never decreasing
  bool visible = true;      ///< passes the depth test
};

/// Noise of R3LIVE's estimate, in grey values: standard deviation of one observation, and of the
/// colour's random walk after one second.
inline constexpr float kBayesObservation = 15.0f, kBayesWalk = 5.0f;

/// All rules' knowledge of one point: of fixed size, however many views there are.
struct ColorState {
  static constexpr std::uint32_t kSamples = 15;

  std::uint32_t views = 0, visible_views = 0;
  Rgb first, last, nearest, best;
  float nearest_distance = std::numeric_limits<float>::infinity();
  float best_weight = -1;
  std::array<float, 3> mean{}, bayes{};
  float bayes_variance = 0, bayes_time = 0;
  std::array<Rgb, kSamples> samples{};  ///< a uniform sample of the visible views (reservoir)
};

/// Takes in one view, in the order of time.
/// @param point  the point's number: seeds its sampling
void observe(ColorState& state, const ColorObservation& seen, std::uint64_t point);

/// The colour by a rule; empty if no view gave it one. Not of kFovea and kFloor, which need more
/// than the views: std::invalid_argument.
std::optional<Rgb> color_by(ColorRule rule, const ColorState& state);

}  // namespace fovea
