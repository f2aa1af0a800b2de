#include "fovea/exporting/views/nerf_writer.h"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "fovea/drive/writers/png_encode.h"
#include "fovea/map/point_files/byte_packer.h"

namespace fovea {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kPoints = "points.ply";

constexpr const char* kMaskFolder = "masks";

std::string mask_path(const Camera& camera) {
  return fmt::format("{}/camera_{}.png", kMaskFolder, camera.index);
}

std::string file_path(const PosedImage& image) {
  return fmt::format("{}/{}", kImageFolder, image.file_name());
}

void put_camera(const Camera& camera, OrderedJson& json) {
  const Eigen::Vector2d center = principal_point_from_corner(camera);
  json["w"] = camera.width, json["h"] = camera.height;
  json["fl_x"] = camera.fx, json["fl_y"] = camera.fy;
  json["cx"] = center.x(), json["cy"] = center.y();
}

/// From the camera to the local frame, with y up and z backward.
OrderedJson transform_matrix(const RigidMotion& T_cam_local) {
  Eigen::Matrix4d T = T_cam_local.inverse().matrix();
  T.middleCols<2>(1) *= -1;
  OrderedJson rows = OrderedJson::array();
  for (int row = 0; row < 4; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
  return rows;
}

bool has_one_camera(const std::vector<PosedImage>& images) {
  std::set<std::pair<std::size_t, int>> cameras;
  for (const PosedImage& image : images) cameras.emplace(image.drive, image.camera.index);
  return cameras.size() == 1;
}

/// The splits of nerfstudio, which needs all three of them.
void put_splits(const std::vector<PosedImage>& images, OrderedJson& json) {
  OrderedJson train = OrderedJson::array(), test = OrderedJson::array();
  for (const PosedImage& image : images) {
    (image.is_held_out ? test : train).push_back(file_path(image));
  }
  if (test.empty()) return;
  json["train_filenames"] = train;
  json["val_filenames"] = test;
  json["test_filenames"] = test;
}

std::string transforms(const std::vector<PosedImage>& images, bool has_masks) {
  OrderedJson json;
  json["camera_model"] = "PINHOLE";
  json["aabb_scale"] = 128;  // of instant-ngp: its largest
  json["ply_file_path"] = kPoints;
  const bool is_one_camera = has_one_camera(images);
  if (is_one_camera) put_camera(images.front().camera, json);
  put_splits(images, json);
  json["frames"] = OrderedJson::array();
  for (const PosedImage& image : images) {
    OrderedJson frame;
    frame["file_path"] = file_path(image);
    if (has_masks) frame["mask_path"] = mask_path(image.camera);
    if (!is_one_camera) put_camera(image.camera, frame);
    frame["transform_matrix"] = transform_matrix(image.T_cam_local);
    json["frames"].push_back(std::move(frame));
  }
  return json.dump(1) + "\n";
}

/// Black where the mask covers the scene. @param mask  nullptr: nowhere
Image mask_picture(const Camera& camera, const ImageMask* mask) {
  Image picture(camera.width, camera.height, 1);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const bool is_covered = mask != nullptr && mask->covers(float(u), float(v), 0);
      picture.pixel(u, v)[0] = is_covered ? 0 : 255;
    }
  }
  return picture;
}

/// Masks of all cameras if one has a mask: nerfstudio needs one for each image, or none.
void write_masks(const ViewExport& views, const OutputFolder& folder) {
  std::map<int, const Camera*> cameras;
  for (const PosedImage& image : views.images) cameras[image.camera.index] = &image.camera;
  for (const auto& [index, camera] : cameras) {
    const auto mask = views.masks.find(index);
    const std::vector<std::uint8_t> png =
        encode_png(mask_picture(*camera, mask == views.masks.end() ? nullptr : &mask->second));
    folder.write(mask_path(*camera), {reinterpret_cast<const char*>(png.data()), png.size()});
  }
}

std::string points_ply(const std::vector<PointThinner::Point>& points) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar "
      "blue\nend_header\n",
      points.size());
  BytePacker packer(bytes);
  for (const auto& [position, color] : points) {
    for (int axis = 0; axis < 3; ++axis) packer.put(static_cast<float>(position[axis]));
    packer.put(color.r);
    packer.put(color.g);
    packer.put(color.b);
  }
  return bytes;
}

}  // namespace

ViewExportFigures write_nerf(const MapReader& map, const std::filesystem::path& map_path,
                             const std::filesystem::path& path, const ViewExportOptions& options) {
  OutputFolder folder(path, options.force, {"transforms.json", kPoints, kImageFolder, kMaskFolder});
  const ViewExport views = gather_views(map, map_path, options, folder);
  folder.write(kPoints, points_ply(views.points));
  const bool has_masks = !views.masks.empty();
  if (has_masks) write_masks(views, folder);
  folder.write("transforms.json", transforms(views.images, has_masks));
  folder.commit();
  return views.figures;
}

}  // namespace fovea
