#include "fovea/map/tile_codec.h"

#include <fmt/format.h>
#define ZSTD_STATIC_LINKING_ONLY  // for how literals are kept
#include <zstd.h>

#include <new>
#include <stdexcept>

#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/map/zstd_blob.h"

namespace fovea {
namespace {

/// The fastest keeps up with the mapper; the columns are packed so that it finds what there is.
constexpr int kCompressionLevel = 1;
/// With a table of 8 kB instead of 32 it leaves the caches to the mapper: an eighth less time, and
/// one byte in a hundred more.
constexpr int kTableLog = 11;
/// In noise it looks at every 32nd place alone for what comes again: 0.7 of the time, and two bytes
/// in a hundred more of those columns.
constexpr int kSeldom = 32;

void check(std::size_t zstd_result) {
  // With the bound that zstd asks for only memory can run out.
  if (ZSTD_isError(zstd_result) != 0) throw std::bad_alloc();
}

/// Bytes that the end of a part costs at most.
constexpr std::size_t kMostOfFlush = 16;

}  // namespace

Row cells_of(const TileRow& row) {
  Row cells;
  cells.reserve(kTilesTable.column_count());
  for (const std::int64_t number : {row.submap, std::int64_t{row.key.x}, std::int64_t{row.key.y},
                                    std::int64_t{row.key.z}, row.points, row.colored}) {
    cells.emplace_back(number);
  }
  for (const double coordinate : row.origin) cells.push_back(cell(coordinate));
  for (const std::span<const std::byte> blob : row.blobs) {
    cells.push_back(blob.empty() ? Cell() : Cell(blob));
  }
  return cells;
}

std::uint64_t checksum(const TileRow& row) { return row_checksum(kTilesTable, cells_of(row)); }

TileEncoder::TileEncoder() : context_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
  if (context_ == nullptr) throw std::bad_alloc();
  check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kCompressionLevel));
  check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_hashLog, kTableLog));
}
TileEncoder::~TileEncoder() = default;

TileRow TileEncoder::encode(const PackedTile& tile) {
  TileRow row;
  row.submap = static_cast<std::int64_t>(tile.id.submap);
  row.key = tile.id.key;
  row.points = tile.points;
  row.colored = tile.colored;
  row.origin = tile.origin;
  std::array<std::size_t, kStoredColumns> size{};
  blobs_.clear();
  for (std::size_t i = 0; i < kStoredColumns; ++i) {
    const std::vector<std::byte>& column = tile.columns[i];
    if (i >= kFirstOptionalColumn && column.empty()) continue;
    const std::span<const std::byte> blob = compress(column, kind_of(i));
    blobs_.insert(blobs_.end(), blob.begin(), blob.end());
    size[i] = blob.size();
  }
  for (std::size_t i = 0, begin = 0; i < kStoredColumns; begin += size[i++]) {
    row.blobs[i] = std::span(blobs_).subspan(begin, size[i]);
  }
  row.checksum = checksum(row);
  return row;
}

std::span<const std::byte> TileEncoder::compress(std::span<const std::byte> column,
                                                 const ColumnKind& kind) {
  check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_targetLength, kind.is_noisy ? kSeldom : 0));
  // Otherwise it would keep bytes as they are where it looks seldom. A library that cannot be asked
  // for this does so.
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_literalCompressionMode,
                         kind.is_noisy ? ZSTD_ps_enable : ZSTD_ps_auto);
  check(ZSTD_CCtx_setPledgedSrcSize(context_.get(), column.size()));
  const std::size_t most = ZSTD_compressBound(column.size()) + kind.parts * kMostOfFlush;
  if (room_.size() < most) room_.resize(most);
  ZSTD_outBuffer out{room_.data(), room_.size(), 0};
  const std::size_t size = column.size() / kind.parts;
  for (std::size_t part = 0; part < kind.parts; ++part) {
    // Each has a block, and so a code, of its own.
    ZSTD_inBuffer in{column.data() + part * size, size, 0};
    const bool is_last = part + 1 == kind.parts;
    check(ZSTD_compressStream2(context_.get(), &out, &in, is_last ? ZSTD_e_end : ZSTD_e_flush));
  }
  return std::span(room_).first(out.pos);
}

TileDecoder::TileDecoder(const TileFormat& format)
    : format_(format), context_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
  if (context_ == nullptr) throw std::bad_alloc();
}
TileDecoder::~TileDecoder() = default;

TilePoints TileDecoder::decode(const TileRow& row, const std::string& map_path) {
  const auto fail = [&](const char* what) {
    throw InputError(what,
                     fmt::format("{}, tile {} {} {} of submap {}", map_path, row.key.x, row.key.y,
                                 row.key.z, row.submap),
                     kRestoreMap);
  };
  if (format_.checksum(row) != row.checksum) fail("the checksum of a tile is wrong");
  if (row.points < 0 || row.points > kMaxTilePoints || !row.origin.allFinite()) {
    fail("a tile has an impossible size or origin");
  }
  TilePoints tile;
  tile.origin = row.origin;
  const auto points = static_cast<std::size_t>(row.points);
  for (std::size_t i = 0; i < kStoredColumns; ++i) {
    const std::span<const std::byte> blob = row.blobs[i];
    if (i >= kFirstOptionalColumn && blob.empty()) continue;
    const auto unpacked = [&] {
      const std::size_t size = ZSTD_getFrameContentSize(blob.data(), blob.size());
      if (!format_.packed_sizes(i, points).allow(size)) return false;
      // Before memory is taken: a forged row must not ask for what its blobs cannot fill.
      if (!can_hold(blob.size(), size)) return false;
      memory_.resize(size);
      return ZSTD_decompressDCtx(context_.get(), memory_.data(), size, blob.data(), blob.size()) ==
                 size &&
             format_.unpack_column(i, memory_, points, tile);
    };
    if (!unpacked()) fail("a column of a tile cannot be decoded");
  }
  tile.widen_boxes(0);
  if (count_colored(tile) != row.colored) fail("a tile has another number of colored points");
  return tile;
}

}  // namespace fovea
