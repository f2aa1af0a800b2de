// What holds of every cloud that `evaluate` reads.
#pragma once

#include "fovea/map/point_files/cloud_format.h"
#include "fuzz_input.h"

namespace fovea {

inline void fuzz_cloud(CloudFormat format, const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  read_or_refuse([&] {
    const CloudFile cloud = read_cloud(file.hold(as_text(data, size)), format, {1, 2, 3});
    cloud.points.check();
    require(cloud.points.color.size() == cloud.points.size() &&
                cloud.points.camera.size() == cloud.points.size(),
            "points have a colour and a camera");
    for (const Eigen::Vector3f& p : cloud.points.position) {
      require(p.cwiseAbs().maxCoeff() <= 50e3f, "points lie within reach");
    }
  });
}

}  // namespace fovea
