// Colors your points by your image: color_cloud SCAN.bin IMAGE CAMERA.txt OUT.ply
// SCAN.bin has x y z intensity as floats, in the frame of the LiDAR. CAMERA.txt has fx fy cx cy,
// and the first three rows of T_cam_lidar. The image is without distortion.
#include <fovea/fovea.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>

fovea::PointCloud read_scan(const char* name) {
  fovea::PointCloud scan_lidar;
  std::ifstream file(name, std::ios::binary);
  std::array<float, 4> point;
  while (file.read(reinterpret_cast<char*>(point.data()), sizeof(point))) {
    scan_lidar.position.emplace_back(point[0], point[1], point[2]);
    scan_lidar.intensity.push_back(point[3]);
  }
  return scan_lidar;
}

fovea::Camera read_camera(const char* name, const fovea::Image& image) {
  fovea::Camera camera;
  camera.width = image.width, camera.height = image.height;
  std::ifstream file(name);
  file >> camera.fx >> camera.fy >> camera.cx >> camera.cy;
  for (int i = 0; i < 12; ++i) file >> camera.T_cam_lidar(i / 4, i % 4);
  if (!file || !fovea::is_rotation(camera.T_cam_lidar.linear())) {
    throw fovea::InputError("has no camera", name,
                            "give fx fy cx cy and 12 numbers of T_cam_lidar");
  }
  return camera;
}

int main(int count, char** arguments) {
  if (count != 5) return std::fputs("color_cloud SCAN.bin IMAGE CAMERA.txt OUT.ply\n", stderr), 2;
  try {
    fovea::PointCloud scan = read_scan(arguments[1]);
    const fovea::Image image = fovea::read_image(arguments[2]);
    const fovea::Camera camera = read_camera(arguments[3], image);

    const std::vector<Eigen::Vector3f> p_lidar = scan.position;
    for (Eigen::Vector3f& p : scan.position) {
      p = (camera.T_cam_lidar * p.cast<double>()).cast<float>();
    }
    fovea::color_points(scan, {image, camera});
    scan.position = p_lidar;
    fovea::write_cloud_ply(scan, arguments[4], true);

    const auto uncolored = std::count(scan.camera.begin(), scan.camera.end(), fovea::kNoCamera);
    std::printf("%td of %zu points have a color\n", std::ptrdiff_t(scan.size()) - uncolored,
                scan.size());
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
