#include "fovea/map/point_files/cloud_ply.h"

#include <fmt/format.h>

#include <bit>

#include "fovea/core/output_file.h"

namespace fovea {

static_assert(std::endian::native ==
              std::endian::little);  // values are written as they lie in memory

void write_cloud_ply(const PointCloud& cloud, const std::filesystem::path& path, bool force) {
  OutputFile file(path, force);
  const bool intensity = !cloud.intensity.empty(), interpolated = !cloud.interpolated.empty();
  file.stream() << fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\n"
      "property float z\n{}{}end_header\n",
      cloud.size(), intensity ? "property float intensity\n" : "",
      interpolated ? "property uchar interpolated\n" : "");
  const auto put = [&](const void* value, std::streamsize size) {
    file.stream().write(static_cast<const char*>(value), size);
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = (cloud.origin + cloud.position[i].cast<double>()).cast<float>();
    put(p.data(), sizeof(float) * 3);
    if (intensity) put(&cloud.intensity[i], sizeof(float));
    if (interpolated) put(&cloud.interpolated[i], 1);
  }
  file.commit();
}

}  // namespace fovea
