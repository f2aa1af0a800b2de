#include "fovea/map/tile_codec.h"

#include <gtest/gtest.h>

#include "../../../tests/peak_memory.h"
#include "../../../tests/sample_map.h"
#include "fovea/errors.h"

namespace fovea::tile_codec_test {

TEST(TileDecoder, AForgedSizeTakesNoMemory) {
  TileEncoder encoder;
  TileRow row = encoder.encode(pack_tile({}, TilePoints::of(one_point_each({{1, 1, 1}}))));
  row.points = kMaxTilePoints;
  // zstd: a frame whose header has its size in 8 bytes, and one block that repeats a byte.
  std::vector<std::uint8_t> frame{0x28, 0xb5, 0x2f, 0xfd, 0xe0};
  const std::uint64_t size = packed_sizes(0, static_cast<std::size_t>(row.points)).most;
  for (int i = 0; i < 8; ++i) frame.push_back(static_cast<std::uint8_t>(size >> (8 * i)));
  frame.insert(frame.end(), {0x03, 0x00, 0x10, 0});
  row.blobs[0] = std::as_bytes(std::span(frame));
  row.checksum = checksum(row);
  TileDecoder decoder;
  EXPECT_LT(rise_of_peak_memory([&] { EXPECT_THROW(decoder.decode(row, "map"), InputError); }),
            kMemoryOfASmallFile);
}

// A column that is the same everywhere compresses to a thousandth and less.
TEST(TileDecoder, LargeTilesOfOneValueComeBack) {
  PointCloud tile = one_point_each(std::vector<Eigen::Vector3f>(1 << 20, Eigen::Vector3f::Zero()));
  tile.sampling_level.assign(tile.size(), 0);
  TileEncoder encoder;
  TileDecoder decoder;
  const TileRow row = encoder.encode(pack_tile({}, TilePoints::of(tile)));
  expect_same_columns(decoder.decode(row, "map").cloud(), tile);
}

TEST(TileDecoder, RunsThatDoNotAddUpAreRefused) {
  constexpr std::size_t kCamera = 2;
  TileEncoder encoder;
  TileDecoder decoder;
  PackedTile tile = pack_tile({}, TilePoints::of(one_point_each({{1, 1, 1}, {1, 2, 1}})));
  ASSERT_EQ(tile.columns[kCamera].size(), 2u);
  EXPECT_EQ(decoder.decode(encoder.encode(tile), "map").size(), 2u);
  tile.columns[kCamera][1] = std::byte{2};
  EXPECT_THROW(decoder.decode(encoder.encode(tile), "map"), InputError);
}

// A tile that is read again is looked for by its box.
TEST(TileDecoder, TheBoxComesBack) {
  const TilePoints tile = TilePoints::of(one_point_each({{1, 2, 0.5f}, {0.25f, 3, 4}}));
  TileEncoder encoder;
  TileDecoder decoder;
  const TilePoints back = decoder.decode(encoder.encode(pack_tile({}, tile)), "map");
  EXPECT_EQ(back.box.low, tile.box.low);
  EXPECT_EQ(back.box.high, tile.box.high);
}

}  // namespace fovea::tile_codec_test
