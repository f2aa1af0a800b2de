#include "fovea/exporting/views/colmap_writer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace fovea {
namespace {

/// Numbers of the cameras in the model, by drive and camera of the drive.
using CameraNumbers = std::map<std::pair<std::size_t, int>, int>;

std::string cameras_text(const std::vector<PosedImage>& images, CameraNumbers& numbers) {
  std::string text = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (const PosedImage& image : images) {
    const Camera& camera = image.camera;
    const auto [number, is_new] =
        numbers.try_emplace({image.drive, camera.index}, int(numbers.size()) + 1);
    if (!is_new) continue;
    const Eigen::Vector2d center = principal_point_from_corner(camera);
    text += fmt::format("{} PINHOLE {} {} {} {} {} {}\n", number->second, camera.width,
                        camera.height, camera.fx, camera.fy, center.x(), center.y());
  }
  return text;
}

std::string images_text(const std::vector<PosedImage>& images, const CameraNumbers& numbers) {
  std::string text =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "# POINTS2D[] as (X, Y, POINT3D_ID): none\n";
  for (std::size_t i = 0; i < images.size(); ++i) {
    const PosedImage& image = images[i];
    Eigen::Quaterniond q(image.T_cam_local.linear());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const Eigen::Vector3d t = image.T_cam_local.translation();
    text +=
        fmt::format("{} {} {} {} {} {} {} {} {} {}\n\n", i + 1, q.w(), q.x(), q.y(), q.z(), t.x(),
                    t.y(), t.z(), numbers.at({image.drive, image.camera.index}), image.file_name());
  }
  return text;
}

std::string points_text(const std::vector<PointThinner::Point>& points) {
  std::string text =
      "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX): none\n";
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, color] = points[i];
    fmt::format_to(out, "{} {:.4f} {:.4f} {:.4f} {} {} {} 0\n", i + 1, p.x(), p.y(), p.z(), color.r,
                   color.g, color.b);
  }
  return text;
}

std::string held_out_names(const std::vector<PosedImage>& images) {
  std::string text;
  for (const PosedImage& image : images) {
    if (image.is_held_out) text += image.file_name() + "\n";
  }
  return text;
}

}  // namespace

ViewExportFigures write_colmap(const MapReader& map, const std::filesystem::path& map_path,
                               const std::filesystem::path& path,
                               const ViewExportOptions& options) {
  OutputFolder folder(path, options.force, {"sparse", kImageFolder});
  const ViewExport views = gather_views(map, map_path, options, folder);
  CameraNumbers numbers;
  const std::filesystem::path model = std::filesystem::path("sparse") / "0";
  folder.write(model / "cameras.txt", cameras_text(views.images, numbers));
  folder.write(model / "images.txt", images_text(views.images, numbers));
  folder.write(model / "points3D.txt", points_text(views.points));
  const std::string held_out = held_out_names(views.images);
  if (!held_out.empty()) folder.write(model / "test.txt", held_out);
  folder.commit();
  return views.figures;
}

}  // namespace fovea
