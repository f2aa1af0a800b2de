#include "fovea/evaluation/predicted_gain.h"

#include <cmath>

namespace fovea {

std::optional<Eigen::Vector3f> predicted_gain(const std::vector<FrameRecord>& frames, int frame,
                                              int camera) {
  std::optional<Eigen::Vector3d> before, after;  // base-2 logarithms
  for (const FrameRecord& record : frames) {
    for (const ViewRecord& view : record.views) {
      if (view.camera != camera || !view.log2_gain) continue;
      if (record.index < frame) before = view.log2_gain;
      if (record.index > frame && !after) after = view.log2_gain;
    }
  }
  if (!before && !after) return std::nullopt;
  const Eigen::Vector3d& first = before ? *before : *after;
  const Eigen::Vector3d& second = after ? *after : *before;
  const Eigen::Array3d gain = (first + second).array() / 2;
  return gain.unaryExpr([](double log2) { return std::exp2(log2); }).cast<float>().matrix();
}

}  // namespace fovea
