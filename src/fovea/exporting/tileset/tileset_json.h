// A tree of tiles as a 3D Tiles 1.1 tileset.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fovea/exporting/tileset/tile_tree.h"
#include "fovea/geometry/geodesy.h"

namespace fovea {

/// Where the writers put a tile's content, within the tileset's folder.
inline std::string tile_uri(const std::string& tile) { return "tiles/" + tile + ".glb"; }

/// tileset.json: tiles replace their parents, a tile's geometric error is the spacing that its
/// points were thinned to.
/// @param root    of a leaf without tiles: a tileset without content
/// @param origin  where the local frame lies on earth: the root's transform; nothing: none
/// @param uri     of a node's content, by the node's name; empty: it has none
std::string tileset_json(const TileNode& root, const std::optional<GeodeticPoint>& origin,
                         const std::function<std::string(const std::string& name)>& uri);

// Parts of a tileset.

/// The begin of a tileset up to the members of its root.
std::string tileset_begin(double geometric_error);
/// The members after `tileset_begin()` of a tileset without content.
std::string no_content_json();
/// The member "boundingVolume".
/// @param T_parent_box  the frame of the box in that of the tile
std::string bounding_volume_json(const Eigen::AlignedBox3d& box,
                                 const RigidMotion& T_parent_box = RigidMotion::Identity());
/// The member "transform", with a comma after it.
std::string transform_json(const RigidMotion& T_parent_tile);

}  // namespace fovea
