#include "fovea/exporting/tileset/tileset_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "fovea/core/version.h"

namespace fovea {
namespace {

using Uri = std::function<std::string(const std::string& name)>;

std::string bounding_volume(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d center = box.center(), half = box.sizes() / 2;
  return fmt::format(R"("boundingVolume":{{"box":[{},{},{},{},0,0,0,{},0,0,0,{}]}})", center.x(),
                     center.y(), center.z(), half.x(), half.y(), half.z());
}

/// What a tile's object has between its braces.
void append_tile(std::string& json, const TileNode& node, const Uri& uri) {
  json += fmt::format(R"({},"geometricError":{},"content":{{"uri":"{}"}})",
                      bounding_volume(node.box), node.spacing, uri(node.name));
  if (node.is_leaf()) return;
  json += ",\"children\":[";
  for (const TileNode& child : node.children) {
    json += &child == &node.children.front() ? "\n{" : ",\n{";
    append_tile(json, child, uri);
    json += '}';
  }
  json += ']';
}

/// Column by column, as glTF and 3D Tiles have matrices.
std::string transform(const GeodeticPoint& origin) {
  const Eigen::Matrix4d T = T_ecef_enu(origin).matrix();
  return fmt::format("\"transform\":[{}],", fmt::join(T.data(), T.data() + T.size(), ","));
}

}  // namespace

std::string tileset_json(const TileNode& root, const std::optional<GeodeticPoint>& origin,
                         const Uri& uri) {
  const bool empty = root.box.isEmpty();
  std::string json = fmt::format(
      R"({{"asset":{{"version":"1.1","generator":"fovea {}"}},"geometricError":{},"root":{{)",
      version(), empty ? 0 : root.box.sizes().maxCoeff());
  if (origin) json += transform(*origin);
  json += R"("refine":"REPLACE",)";
  if (empty) {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    json += bounding_volume({zero, zero}) + R"(,"geometricError":0)";
  } else {
    append_tile(json, root, uri);
  }
  return json + "}}\n";
}

}  // namespace fovea
