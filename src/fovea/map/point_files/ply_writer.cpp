#include "fovea/map/point_files/ply_writer.h"

#include <fmt/format.h>

#include <string>

#include "fovea/map/point_files/point_packing.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

std::string ply_header(const PointStream& points, const PointFileOptions& options,
                       bool has_intensity) {
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\ncomment fovea {}\n", version());
  const Georeference& georeference = points.georeference();
  if (georeference.origin()) {
    text += fmt::format("comment {}\ncomment crs {}\n", georeference.description(),
                        georeference.wkt2());
  }
  if (options.points.include_uncolored) {
    text += fmt::format("comment camera -1: no camera saw the point, its colour {} {} {} is none\n",
                        kUncolored.r, kUncolored.g, kUncolored.b);
  }
  text += fmt::format("comment {}\n", points.exposure());
  text += fmt::format("element vertex {}\n", points.figures().points);
  const char* real = options.doubles() ? "double" : "float";
  for (const char* axis : {"x", "y", "z"}) text += fmt::format("property {} {}\n", real, axis);
  const char* color = options.points.deep_colors ? "ushort" : "uchar";
  for (const char* name : {"red", "green", "blue"}) {
    text += fmt::format("property {} {}\n", color, name);
  }
  text +=
      "property char camera\n"
      "property int frame\nproperty float range\nproperty uchar interpolated\n"
      "property uchar views\nproperty uchar spread\nproperty uchar reason\n";
  if (has_intensity) text += "property float intensity\n";
  return text + "end_header\n";
}

}  // namespace

ExportFigures write_ply(const MapReader& map, const std::filesystem::path& path,
                        const PointFileOptions& options) {
  return write_point_file(map, path, options, ply_header, [](Rgb color, BytePacker& packer) {
    packer.put(color.r);
    packer.put(color.g);
    packer.put(color.b);
  });
}

}  // namespace fovea
