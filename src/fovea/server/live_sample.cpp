#include "fovea/server/live_sample.h"

#include <array>
#include <cstring>

#include "fovea/map/point_files/byte_packer.h"
#include "fovea/map/point_files/point_source.h"

namespace fovea {
namespace {

constexpr int kCells = 64;  // along an edge
constexpr std::uint32_t kPointsKind = 1;

/// @param cells_per_m  along each axis
std::uint32_t cell_of(const Eigen::Vector3f& p_tile, float cells_per_m) {
  const Eigen::Array3i cell =
      (p_tile.array() * cells_per_m).cast<int>().max(0).min(kCells - 1);  // inside but for rounding
  return static_cast<std::uint32_t>((cell.x() * kCells + cell.y()) * kCells + cell.z());
}

static_assert(kPositionStep == 0.001f);  // a live message has positions in whole millimetres

}  // namespace

bool LiveSample::has_lost_points(const TilePoints& tile) const {
  if (looked_at_ == 0) return false;
  return tile.size() < looked_at_ || tile.position_at(looked_at_ - 1) != last_;
}

std::span<const std::uint32_t> LiveSample::more(const TilePoints& tile, double tile_size) {
  if (has_lost_points(tile)) *this = LiveSample();
  if (taken_.empty()) taken_.resize(std::size_t{kCells} * kCells * kCells);
  const std::size_t before = chosen_.size();
  const auto cells_per_m = static_cast<float>(kCells / tile_size);
  for (; looked_at_ < tile.size(); ++looked_at_) {
    const std::uint32_t cell = cell_of(tile.position_at(looked_at_), cells_per_m);
    if (taken_[cell]) continue;
    taken_[cell] = true;
    chosen_.push_back(static_cast<std::uint32_t>(looked_at_));
  }
  if (looked_at_ > 0) last_ = tile.position_at(looked_at_ - 1);
  return std::span(chosen_).subspan(before);
}

void append_section(std::string& message, const TileId& id, const TilePoints* tile,
                    std::span<const std::uint32_t> points, bool whole) {
  BytePacker packer(message);
  packer.put(static_cast<std::uint32_t>(id.submap));
  for (const std::int32_t axis : {id.key.x, id.key.y, id.key.z}) packer.put(axis);
  packer.put(std::uint32_t{whole});
  packer.put(static_cast<std::uint32_t>(points.size()));
  if (tile == nullptr) return;
  // Value by value a string grows too slowly for what the mapper waits for.
  const std::size_t at = message.size(), padding = points.size() % 2 * 2;
  message.resize(at + 22 * points.size() + padding);
  char* to = message.data() + at;
  const auto put = [&to](const auto& values) {
    std::memcpy(to, values.data(), sizeof(values));
    to += sizeof(values);
  };
  for (const std::uint32_t i : points) {
    put(std::array{tile->position[0][i], tile->position[1][i], tile->position[2][i]});
  }
  to += padding;
  for (const std::uint32_t i : points) {
    const Rgb color = to_rgb(tile->colors[i].color);
    put(std::array{color.r, color.g, color.b, static_cast<std::uint8_t>(tile->camera[i])});
  }
  for (const std::uint32_t i : points) {
    const FusedColor& color = tile->colors[i];
    put(std::array{rule_byte(tile->reason[i], tile->interpolated[i]), color.views, color.spread,
                   std::uint8_t{0}});
  }
  for (const std::uint32_t i : points) put(std::array{static_cast<float>(tile->frame[i])});
  for (const std::uint32_t i : points) {
    put(std::array{sight_range(tile->range_at(i)), sight_incidence(tile->incidence_at(i))});
  }
}

std::string points_header(int frame, std::size_t sections) {
  std::string header;
  BytePacker packer(header);
  packer.put(kPointsKind);
  packer.put(static_cast<std::int32_t>(frame));
  packer.put(static_cast<std::uint32_t>(sections));
  return header;
}

}  // namespace fovea
