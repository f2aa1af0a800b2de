#include "fovea/exporting/city/city_tileset_json.h"

#include <fmt/format.h>

#include "fovea/exporting/tileset/tileset_json.h"

namespace fovea {
namespace {

std::string content_json(const std::string& uri) {
  return uri.empty() ? "" : fmt::format(R"(,"content":{{"uri":"{}"}})", uri);
}

void append_entry(std::string& json, const CityNode& node, const CityTileEntry& entry) {
  const std::string volume =
      fmt::format(R"({},"geometricError":{})",
                  bounding_volume_json(node.tile_box, entry.T_entry_tile), node.spacing);
  json += transform_json(entry.T_parent_entry) + volume + content_json(entry.content);
  if (!entry.below.empty()) {
    json += ",\"children\":[\n{" + volume + content_json(entry.below) + "}]";
  }
}

/// What a node's object has between its braces.
/// @param parent_tiles  number of tiles below its parent in the tileset; 0: it has none
void append_node(std::string& json, const CityNode& node, const CityTilesetForm& form,
                 std::size_t parent_tiles) {
  if (node.tile) return append_entry(json, node, form.tile(node));
  json += fmt::format(R"({},"geometricError":{})", bounding_volume_json(node.box), node.spacing);
  const std::string subtree = begins_tileset(node, parent_tiles) ? form.subtree(node) : "";
  if (!subtree.empty()) {
    json += content_json(subtree);
    return;
  }
  json += content_json(form.content(node)) + ",\"children\":[";
  bool is_first = true;
  for (const CityNode& child : node.children) {
    if (child.box.isEmpty()) continue;  // it has no points
    json += is_first ? "\n{" : ",\n{";
    is_first = false;
    append_node(json, child, form, node.tiles);
    json += '}';
  }
  json += ']';
}

}  // namespace

std::string city_tileset_json(const CityNode& root, const CityTilesetForm& form) {
  const bool is_empty = root.box.isEmpty();
  std::string json = tileset_begin(is_empty ? 0 : root.box.sizes().maxCoeff());
  if (form.T_parent_root) json += transform_json(*form.T_parent_root);
  json += R"("refine":"REPLACE",)";
  if (is_empty) {
    json += no_content_json();
  } else {
    append_node(json, root, form, /*parent_tiles=*/0);
  }
  return json + "}}\n";
}

}  // namespace fovea
