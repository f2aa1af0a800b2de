#include "fovea/exporting/ply_writer.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string>

#include "fovea/base/errors.h"
#include "fovea/base/output_file.h"
#include "fovea/base/version.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

// Values are written as they lie in memory; the header says little endian.
static_assert(std::endian::native == std::endian::little);

/// A number of the map's meta. Parsed, because text of a map from elsewhere could hold a line end.
std::optional<double> number(const MapMeta& meta, const char* key) {
  const auto found = meta.find(key);
  if (found == meta.end()) return std::nullopt;
  const std::optional<std::vector<double>> numbers = numbers_from_text(found->second);
  if (!numbers || numbers->size() != 1) return std::nullopt;
  return numbers->front();
}

std::string header(const MapMeta& meta, std::size_t points, const PlyOptions& options) {
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\ncomment fovea {}\n", version());
  const auto latitude = number(meta, "origin.latitude"),
             longitude = number(meta, "origin.longitude"),
             altitude = number(meta, "origin.altitude");
  if (latitude && longitude && altitude) {
    text += fmt::format(
        "comment east-north-up metres; origin latitude {} longitude {} degrees, altitude {} m\n",
        *latitude, *longitude, *altitude);
  }
  if (options.include_uncolored) {
    text += fmt::format("comment camera -1: no camera saw the point, its colour {} {} {} is none\n",
                        kUncolored.r, kUncolored.g, kUncolored.b);
  }
  const char* real = options.double_positions ? "double" : "float";
  text += fmt::format("element vertex {}\n", points);
  for (const char* axis : {"x", "y", "z"}) text += fmt::format("property {} {}\n", real, axis);
  return text +
         "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty char camera\n"
         "property int frame\nproperty float range\nproperty uchar interpolated\n"
         "property uchar views\nproperty uchar spread\nproperty uchar reason\nend_header\n";
}

/// Packs values one behind the other, as PLY wants them.
class Packer {
 public:
  explicit Packer(std::string& bytes) : bytes_(bytes) {}
  template <class T>
  void put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }

 private:
  std::string& bytes_;
};

bool is_chosen(const PointCloud& tile, std::size_t index, const PlyOptions& options) {
  return (options.include_uncolored || tile.camera[index] != kNoCamera) &&
         options.where.matches(tile, index);
}

/// How many points pass, where only a look at each tells.
std::size_t count_chosen(const MapReader& map, const PlyOptions& options) {
  std::size_t count = 0;
  map.for_each_tile([&](std::size_t, const TileKey&, const PointCloud& tile) {
    for (std::size_t i = 0; i < tile.size(); ++i) count += is_chosen(tile, i, options);
  });
  return count;
}

/// Appends the chosen points of a tile to `bytes`; returns how many they are.
std::size_t pack_tile(const PointCloud& tile, const RigidMotion& T_local_submap,
                      const PlyOptions& options, std::string& bytes) {
  Packer packer(bytes);
  std::size_t packed = 0;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    const bool colored = tile.camera[i] != kNoCamera;
    if (!is_chosen(tile, i, options)) continue;
    const Eigen::Vector3d p_local =
        T_local_submap * (tile.origin + tile.position[i].cast<double>());
    for (const double coordinate : p_local) {
      options.double_positions ? packer.put(coordinate)
                               : packer.put(static_cast<float>(coordinate));
    }
    const Rgb color = colored ? tile.color[i] : kUncolored;
    packer.put(color.r);
    packer.put(color.g);
    packer.put(color.b);
    packer.put(tile.camera[i]);
    packer.put(tile.frame[i]);
    packer.put(tile.range[i]);
    packer.put(tile.interpolated[i]);
    packer.put(tile.views[i]);
    packer.put(tile.spread[i]);
    packer.put(tile.reason[i]);
    ++packed;
  }
  return packed;
}

}  // namespace

PlyFigures write_ply(const MapReader& map, const std::filesystem::path& path,
                     const PlyOptions& options) {
  OutputFile file(path, options.force);
  const std::size_t total = map.size();
  PlyFigures figures;
  const std::size_t unfiltered = options.include_uncolored ? total : map.colored_size();
  figures.points = options.where.empty() ? unfiltered : count_chosen(map, options);
  figures.uncolored_left_out = total - unfiltered;
  figures.filtered_out = unfiltered - figures.points;
  file.stream() << header(map.meta(), figures.points, options);

  const std::vector<RigidMotion> T_local_submap = map.submaps();
  std::size_t written = 0;
  std::string bytes;
  map.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    if (submap >= T_local_submap.size()) return;  // new since; the count below tells
    bytes.clear();
    written += pack_tile(tile, T_local_submap[submap], options, bytes);
    file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
  if (written != figures.points) {
    throw InputError("the map changed while it was exported", path.string(),
                     "export it again when nothing writes to it");
  }
  file.commit();
  return figures;
}

}  // namespace fovea
