#include "fovea/evaluation/cross_fit.h"

#include <array>
#include <cmath>

#include "fovea/evaluation/metrics.h"
#include "fovea/mapping/radiometry.h"

namespace fovea {
namespace {

constexpr float kDark = 8;  // gray value

int set_of(const Eigen::Vector2d& pixel) {
  const Eigen::Array2i block = (pixel.array() / kCrossFitBlock).floor().cast<int>();
  return (block.x() + block.y()) & 1;
}

Eigen::Array3f in_channels(const Eigen::Vector3f& color, bool gray) {
  return gray ? Eigen::Array3f::Constant(luma(color)).eval() : color.array().eval();
}

}  // namespace

std::vector<Eigen::Vector3f> cross_fitted(const EvaluatedView& view,
                                          const std::vector<Eigen::Vector3f>& map) {
  struct Set {
    std::vector<Eigen::Vector3f> truth, map;  // 0 where the truth is saturated: fits nothing
    Eigen::Array3f gain(bool gray) const { return fit_gains(truth, map, gray).array(); }
  };
  std::array<Set, 2> sets;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Array3f use = (view.color[i].array() < kSaturatedValue).cast<float>();
    Set& set = sets[std::size_t(set_of(view.pixel[i]))];
    set.truth.push_back(view.color[i].cwiseProduct(use.matrix()));
    set.map.push_back(map[i].cwiseProduct(use.matrix()));
  }
  const std::array<Eigen::Array3f, 2> gain_of_other{sets[1].gain(view.grey),
                                                    sets[0].gain(view.grey)};
  std::vector<Eigen::Vector3f> fitted(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Array3f& gain = gain_of_other[std::size_t(set_of(view.pixel[i]))];
    fitted[i] = (in_channels(map[i], view.grey) * gain).min(255.0f).matrix();
  }
  return fitted;
}

float log_color_error(const Eigen::Vector3f& truth, const Eigen::Vector3f& map, bool gray) {
  const Eigen::Array3f ratio = truth.array().max(kDark) / in_channels(map, gray).max(kDark);
  return std::sqrt(ratio.log().square().mean());
}

}  // namespace fovea
