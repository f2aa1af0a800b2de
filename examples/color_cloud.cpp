// Colors the scan of a frame by all cameras, and writes x y z r g b: color_cloud DRIVE FRAME
// OUT.txt
#include <fovea/fovea.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

int main(int count, char** arguments) {
  if (count != 4) return std::fputs("color_cloud DRIVE FRAME OUT.txt\n", stderr), 2;
  try {
    const fovea::Drive drive(arguments[1]);
    const fovea::DriveFrame frame = drive.load(std::atoi(arguments[2]));
    const fovea::PointCloud& scan_lidar = frame.scan();
    std::ofstream file(arguments[3]);
    std::size_t colored = 0;
    for (std::size_t i = 0; i < drive.cameras().size(); ++i) {
      const fovea::Camera& camera = drive.cameras()[i];
      if (frame.images()[i].empty()) continue;
      fovea::PointCloud points_cam;
      std::vector<std::size_t> number;  // of each point in the scan
      for (std::size_t k = 0; k < scan_lidar.size(); ++k) {
        const Eigen::Vector3d p_cam = camera.T_cam_lidar * scan_lidar.position[k].cast<double>();
        const auto pixel = camera.project(p_cam);
        if (!pixel || !camera.in_view(*pixel)) continue;
        points_cam.position.push_back(p_cam.cast<float>());
        number.push_back(k);
      }
      fovea::color_points(points_cam, {frame.images()[i], camera, frame.index()});
      for (std::size_t k = 0; k < points_cam.size(); ++k) {
        const fovea::Rgb color = to_rgb(points_cam.color[k]);
        file << scan_lidar.position[number[k]].transpose() << ' ' << int(color.r) << ' '
             << int(color.g) << ' ' << int(color.b) << '\n';
      }
      colored += points_cam.size();
    }
    std::printf("%zu of %zu points have a color\n", colored, scan_lidar.size());
    return file.flush() && colored > 0 ? 0 : 1;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
