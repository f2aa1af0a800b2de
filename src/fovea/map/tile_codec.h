// Tiles as the columns of a row: compressed, and protected by a checksum. Private to map/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fovea/map/map_row.h"
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

/// All columns but the checksum. The blobs are shared, not copied.
Row cells_of(const TileRow& row);
/// row_checksum() of the tile.
std::uint64_t checksum(const TileRow& row);

/// What differs between the formats of tiles that can be read.
struct TileFormat {
  std::uint64_t (*checksum)(const TileRow& row);
  PackedSizes (*packed_sizes)(std::size_t column, std::size_t points);
  bool (*unpack_column)(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                        TilePoints& tile);
};
inline constexpr TileFormat kTileFormat{checksum, packed_sizes, unpack_column};

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
  explicit TileDecoder(const TileFormat& format = kTileFormat);
  ~TileDecoder();

  /// The tile of a row; InputError that names tile and `map_path` if the row is damaged.
  TilePoints decode(const TileRow& row, const std::string& map_path);

 private:
  TileFormat format_;
  std::unique_ptr<ZSTD_DCtx_s, std::size_t (*)(ZSTD_DCtx_s*)> context_;
  std::vector<std::byte> memory_;
};

}  // namespace fovea
