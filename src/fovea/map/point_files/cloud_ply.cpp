// A single cloud as a PLY file.
#include <fmt/format.h>

#include <bit>

#include "fovea/core/output_file.h"
#include "fovea/point_cloud.h"

namespace fovea {

static_assert(std::endian::native ==
              std::endian::little);  // values are written as they lie in memory

void write_cloud_ply(const PointCloud& cloud, const std::filesystem::path& file, bool force) {
  cloud.check();
  OutputFile output(file, force);
  const bool colors = !cloud.color.empty() && !cloud.camera.empty();
  const bool intensity = !cloud.intensity.empty(), interpolated = !cloud.interpolated.empty();
  output.stream() << fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\n{}{}{}end_header\n",
      cloud.size(), colors ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
      intensity ? "property float intensity\n" : "",
      interpolated ? "property uchar interpolated\n" : "");
  const auto put = [&](const void* value, std::streamsize size) {
    output.stream().write(static_cast<const char*>(value), size);
  };
  constexpr Rgb kUncolored{128, 128, 128};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = (cloud.origin + cloud.position[i].cast<double>()).cast<float>();
    put(p.data(), sizeof(float) * 3);
    if (colors) {
      const Rgb rgb = cloud.camera[i] == kNoCamera ? kUncolored : to_rgb(cloud.color[i]);
      put(&rgb, sizeof(rgb));
    }
    if (intensity) put(&cloud.intensity[i], sizeof(float));
    if (interpolated) put(&cloud.interpolated[i], 1);
  }
  output.commit();
}

}  // namespace fovea
