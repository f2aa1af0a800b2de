// The quadtree of a city as 3D Tiles 1.1 tilesets.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "fovea/exporting/city/city_tree.h"

namespace fovea {

/// How a tileset refers to a tile of the city.
struct CityTileEntry {
  RigidMotion T_parent_entry = RigidMotion::Identity();  ///< its transform
  RigidMotion T_entry_tile = RigidMotion::Identity();    ///< the tile's frame in it
  std::string content;                                   ///< address
  std::string below;  ///< address of a tileset with finer levels; empty: the content has all
};

/// What the tileset of a city refers to. Addresses are relative to the tileset.
struct CityTilesetForm {
  /// Transform of the root; nothing: none.
  std::optional<RigidMotion> T_parent_root = {};
  /// Address of the points of a node that is no tile; empty: it has none of its own.
  std::function<std::string(const CityNode&)> content;
  /// Address of the tileset that has a node and all below it, where begins_tileset(); empty: these
  /// are part of this one.
  std::function<std::string(const CityNode&)> subtree;
  std::function<CityTileEntry(const CityNode&)> tile;
};

/// tileset.json of a node and all below it. Tiles replace their parents.
std::string city_tileset_json(const CityNode& root, const CityTilesetForm& form);

/// Nodes with more tiles below them are split: each part has a tileset of its own, so that no
/// tileset is larger than a few hundred kilobytes.
inline constexpr std::size_t kMostTilesOfTileset = 256;

/// Whether a node is the root of a tileset of its own below a larger city.
/// @param parent_tiles  number of tiles below its parent
inline bool begins_tileset(const CityNode& node, std::size_t parent_tiles) {
  return node.tiles <= kMostTilesOfTileset && parent_tiles > kMostTilesOfTileset;
}

}  // namespace fovea
