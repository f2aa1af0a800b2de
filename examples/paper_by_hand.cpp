// The paper's steps on one frame: paper_by_hand DRIVE FRAME
#include <fovea/fovea.h>

#include <cstdio>
#include <cstdlib>

int main(int count, char** arguments) {
  if (count != 3) return std::fputs("paper_by_hand DRIVE FRAME\n", stderr), 2;
  try {
    const fovea::Drive drive(arguments[1]);
    const fovea::DriveFrame frame = drive.load(std::atoi(arguments[2]));
    const fovea::Camera camera = drive.cameras().front();

    // Deskew, by the motion that navigation knows.
    fovea::PointCloud scan = frame.scan();
    if (!drive.is_compensated() && drive.navigation()) {
      const auto motion = drive.navigation()->motion(frame.stamp(), frame.stamp());
      if (motion) fovea::compensate_sweep(scan, *motion, drive.sweep());
    }
    // The foveal region, and points between those of the scan.
    const fovea::FovealRegion region({}, camera, fovea::kOneLidar);
    const fovea::PointCloud foveal = fovea::foveal_points(scan, region);
    fovea::PointCloud dense = fovea::upsample(foveal, camera, {.rate = 3, .max_edge = 0.3});

    // The ray filter: which points does the camera see?
    std::vector<fovea::Ray> rays;
    std::vector<std::uint32_t> in_image;
    for (std::size_t i = 0; i < dense.size(); ++i) {
      const Eigen::Vector3d p_cam = dense.position[i].cast<double>();
      const auto pixel = camera.project(p_cam);
      if (!pixel || !camera.in_view(*pixel)) continue;
      rays.push_back({pixel->cast<float>(), dense.position[i].norm()});
      in_image.push_back(static_cast<std::uint32_t>(i));
    }
    fovea::RayFilter filter;
    const auto verdicts = filter.filter(rays, {}, camera, {.window = 9});
    std::vector<std::uint32_t> visible;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (verdicts[i] == fovea::RayVerdict::kVisible) visible.push_back(in_image[i]);
    }
    // Color from the image.
    fovea::PointCloud colored = dense.select(visible);
    fovea::color_points(colored, {frame.images().front(), camera, frame.index()});
    std::printf("%zu points of the scan, %zu in the foveal region, %zu upsampled, %zu visible\n",
                scan.size(), foveal.size(), dense.size(), colored.size());
    return colored.empty() ? 1 : 0;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
