// An adapter: scans, images and poses of your own format become a drive: write_drive FOLDER DRIVE
#include <fovea/fovea.h>

#include <cstdio>
#include <fstream>

namespace {

/// Yours: lines "x y z intensity".
fovea::PointCloud read_scan(const std::filesystem::path& path) {
  std::ifstream file(path);
  fovea::PointCloud points;
  for (float x, y, z, intensity; file >> x >> y >> z >> intensity;) {
    points.position.emplace_back(x, y, z);
    points.intensity.push_back(intensity);
  }
  return points;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return std::fputs("write_drive FOLDER DRIVE\n", stderr), 2;
  try {
    const std::filesystem::path folder = arguments[1];
    fovea::DriveCamera camera{.name = "front", .width = 64, .height = 48};
    camera.fx = camera.fy = 50;
    camera.cx = 31.5;
    camera.cy = 23.5;
    // The camera looks along x of the LiDAR.
    camera.T_lidar_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    fovea::DriveWriter writer(arguments[2], {camera});
    std::ifstream frames(folder / "frames.txt");  // yours: "stamp x y z" of each frame
    fovea::TimeNs stamp = 0;
    Eigen::Vector3d position;
    for (int i = 0; frames >> stamp >> position.x() >> position.y() >> position.z(); ++i) {
      fovea::RigidMotion T_world_lidar = fovea::RigidMotion::Identity();
      T_world_lidar.translation() = position;
      const std::string name = std::to_string(i);
      writer.add({stamp, read_scan(folder / (name + ".txt"))},
                 {{"front", stamp, folder / (name + ".png")}}, T_world_lidar);
    }
    const fovea::WrittenDrive written = writer.close();
    std::printf("%zu scans, %zu images, %zu poses\n", written.scans, written.images, written.poses);
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
