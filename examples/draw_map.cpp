// Draws a map from above, 10 cm a pixel: draw_map MAP.fovea PICTURE.ppm
#include <fovea/fovea.h>

#include <cstdio>
#include <fstream>
#include <limits>

int main(int count, char** arguments) {
  if (count != 3) return std::fputs("draw_map MAP.fovea PICTURE.ppm\n", stderr), 2;
  try {
    const fovea::Map map(arguments[1]);
    const fovea::PointCloud points = map.points({.where = "camera >= 0"});
    const std::vector<fovea::Rgb> colors = map.colors(points);

    constexpr float kPixel = 0.1f;  // m
    Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::max()), high = -low;
    for (const Eigen::Vector3f& p : points.position) {
      low = low.min(p.array());
      high = high.max(p.array());
    }
    if (points.empty()) return std::fputs("the map has no colored points\n", stderr), 1;
    const int width = int((high.x() - low.x()) / kPixel) + 1;
    const int height = int((high.y() - low.y()) / kPixel) + 1;
    fovea::Image picture(width, height, 3);
    std::vector<float> top(std::size_t(width) * std::size_t(height), low.z() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f& p = points.position[i];
      const int x = int((p.x() - low.x()) / kPixel), y = int((high.y() - p.y()) / kPixel);
      float& highest = top[std::size_t(y) * std::size_t(width) + std::size_t(x)];
      if (p.z() < highest) continue;
      highest = p.z();
      std::uint8_t* pixel = picture.pixel(x, y);
      pixel[0] = colors[i].r;
      pixel[1] = colors[i].g;
      pixel[2] = colors[i].b;
    }
    std::ofstream file(arguments[2], std::ios::binary);
    file << "P6\n" << width << ' ' << height << "\n255\n";
    file.write(reinterpret_cast<const char*>(picture.data.data()),
               std::streamsize(picture.data.size()));
    std::printf("%zu points on %d x %d pixels\n", points.size(), width, height);
    return file.flush() ? 0 : 1;
  } catch (const fovea::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 1;
  }
}
