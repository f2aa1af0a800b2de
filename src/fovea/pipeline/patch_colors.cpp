#include "fovea/pipeline/patch_colors.h"

#include <algorithm>

#include "fovea/core/parallel.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/pipeline/foveal_query.h"

namespace fovea {

void color_new_points(PointCloud& points_cam, const ColorView& view) {
  const std::size_t n = points_cam.size();
  points_cam.frame.assign(n, view.frame);
  points_cam.camera.assign(n, static_cast<std::int8_t>(view.camera.index));
  points_cam.color.resize(n);
  points_cam.views.resize(n);
  points_cam.spread.resize(n);
  points_cam.weight.resize(n);
  if (view.has_gain()) {
    for (std::uint8_t& reason : points_cam.reason) reason |= kExposureMatched;
  }
  const PatchColors patches(view);
  parallel_chunks(n, ColorBlock::kSize, [&](std::size_t begin, std::size_t end) {
    ProjectedPoints projected;
    ColorObservations seen{};
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = points_cam.position[i];
      projected.put(i - begin, pixel_of(view.camera, p), p.z());
      seen.weight[i - begin] = view_weight(p.norm());
    }
    patches.at(projected, end - begin, seen.color);
    FusedColors fused{};
    fuse(fused, seen, end - begin);
    const auto first = static_cast<std::ptrdiff_t>(begin);
    std::copy_n(fused.views.begin(), end - begin, points_cam.views.begin() + first);
    std::copy_n(fused.spread.begin(), end - begin, points_cam.spread.begin() + first);
    std::copy_n(fused.weight.begin(), end - begin, points_cam.weight.begin() + first);
    for (std::size_t j = 0; j < end - begin; ++j) {
      points_cam.color[begin + j] = {fused.red[j], fused.green[j], fused.blue[j]};
    }
  });
}

}  // namespace fovea
