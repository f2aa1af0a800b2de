#include "fovea/evaluation/cross_fit.h"

#include <array>
#include <cmath>

namespace fovea {
namespace {

constexpr float kSaturated = 248, kDark = 8;  // gray values

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
  struct Fit {
    Eigen::Array3d products = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
    Eigen::Array3f gain() const {
      return (squares > 0).select(products / squares, 1.0).cast<float>();
    }
  };
  std::array<Fit, 2> fits;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Eigen::Array3f truth = view.color[i].array(), seen = in_channels(map[i], view.grey);
    const Eigen::Array3d use = (truth < kSaturated).cast<double>();
    Fit& fit = fits[std::size_t(set_of(view.pixel[i]))];
    fit.products += use * (truth * seen).cast<double>();
    fit.squares += use * seen.square().cast<double>();
  }
  const std::array<Eigen::Array3f, 2> gain_of_other{fits[1].gain(), fits[0].gain()};
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
