// Tiles as the columns of a row: compressed, and protected by a checksum. Private to map/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fovea/map/packed_tile.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace fovea {

/// A row of `tiles`.
struct TileRow {
  std::int64_t submap = 0;
  TileKey key;
  std::int64_t points = 0;
  std::int64_t colored = 0;  ///< points that a camera has coloured
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  /// zstd frames; empty where the tile lacks the column. They belong to the codec or the database.
  std::array<std::span<const std::byte>, kStoredColumns> blobs;
  std::uint64_t checksum = 0;
};

/// XXH3, 64 bits, of a row's numbers and blobs (docs/map-format.md).
std::uint64_t checksum(const TileRow& row);

class TileEncoder {
 public:
  TileEncoder();
  ~TileEncoder();

  /// The row of a tile; its blobs are valid until the next call.
  TileRow encode(const PackedTile& tile);

 private:
  /// Into room_, which the next call overwrites.
  std::span<const std::byte> compress(std::span<const std::byte> column, const ColumnKind& kind);

  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> context_;
  std::vector<std::byte> room_;   // for what a column takes at most
  std::vector<std::byte> blobs_;  // of a row, one behind the other
};

class TileDecoder {
 public:
  TileDecoder();
  ~TileDecoder();

  /// The tile of a row; InputError that names tile and `map_path` if the row is damaged.
  TilePoints decode(const TileRow& row, const std::string& map_path);

 private:
  std::unique_ptr<ZSTD_DCtx_s, std::size_t (*)(ZSTD_DCtx_s*)> context_;
  std::vector<std::byte> memory_;
};

}  // namespace fovea
