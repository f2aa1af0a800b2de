#include "fovea/exporting/tileset/tileset_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fovea/platform.h"

namespace fovea {
namespace {

using Uri = std::function<std::string(const std::string& name)>;

/// What a tile's object has between its braces.
void append_tile(std::string& json, const TileNode& node, const Uri& uri) {
  json += fmt::format(R"({},"geometricError":{})", bounding_volume_json(node.box), node.spacing);
  const std::string content = uri(node.name);
  if (!content.empty()) json += fmt::format(R"(,"content":{{"uri":"{}"}})", content);
  if (node.is_leaf()) return;
  json += ",\"children\":[";
  for (const TileNode& child : node.children) {
    json += &child == &node.children.front() ? "\n{" : ",\n{";
    append_tile(json, child, uri);
    json += '}';
  }
  json += ']';
}

}  // namespace

std::string tileset_begin(double geometric_error) {
  return fmt::format(
      R"({{"asset":{{"version":"1.1","generator":"fovea {}"}},"geometricError":{},"root":{{)",
      version(), geometric_error);
}

std::string no_content_json() {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  return bounding_volume_json({zero, zero}) + R"(,"geometricError":0)";
}

std::string bounding_volume_json(const Eigen::AlignedBox3d& box, const RigidMotion& T_parent_box) {
  const Eigen::Vector3d center = T_parent_box * box.center();
  const Eigen::Matrix3d half_axes =
      T_parent_box.linear() * Eigen::DiagonalMatrix<double, 3>(box.sizes() / 2);
  return fmt::format(R"("boundingVolume":{{"box":[{},{}]}})",
                     fmt::join(center.data(), center.data() + center.size(), ","),
                     fmt::join(half_axes.data(), half_axes.data() + half_axes.size(), ","));
}

std::string transform_json(const RigidMotion& T_parent_tile) {
  // Column by column, as glTF and 3D Tiles have matrices.
  const Eigen::Matrix4d T = T_parent_tile.matrix();
  return fmt::format("\"transform\":[{}],", fmt::join(T.data(), T.data() + T.size(), ","));
}

std::string tileset_json(const TileNode& root, const std::optional<GeodeticPoint>& origin,
                         const Uri& uri) {
  const bool empty = root.box.isEmpty();
  std::string json = tileset_begin(empty ? 0 : root.box.sizes().maxCoeff());
  if (origin) json += transform_json(T_ecef_enu(*origin));
  json += R"("refine":"REPLACE",)";
  if (empty) {
    json += no_content_json();
  } else {
    append_tile(json, root, uri);
  }
  return json + "}}\n";
}

}  // namespace fovea
