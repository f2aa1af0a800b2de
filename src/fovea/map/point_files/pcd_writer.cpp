#include "fovea/map/point_files/pcd_writer.h"

#include <fmt/format.h>

#include <string>

#include "fovea/map/point_files/point_packing.h"
#include "fovea/platform.h"

namespace fovea {
namespace {

std::string pcd_header(const PointStream& points, const PointFileOptions& options,
                       bool has_intensity) {
  std::string text =
      fmt::format("# .PCD v0.7 - Point Cloud Data file format\n# fovea {}\n", version());
  const Georeference& georeference = points.georeference();
  if (georeference.origin()) {
    text += fmt::format("# {}\n# crs {}\n", georeference.description(), georeference.wkt2());
  }
  text += fmt::format("# {}\n", points.exposure());
  struct Color {
    const char *fields, *size, *type, *count;
  };
  const Color color = options.points.deep_colors ? Color{"r g b", "2 2 2", "U U U", "1 1 1"}
                                                 : Color{"rgb", "4", "F", "1"};
  return text + fmt::format(
                    "VERSION 0.7\n"
                    "FIELDS x y z {2} camera frame range interpolated views spread reason{6}\n"
                    "SIZE {0} {0} {0} {3} 1 4 4 1 1 1 1{7}\n"
                    "TYPE F F F {4} I I F U U U U{8}\n"
                    "COUNT 1 1 1 {5} 1 1 1 1 1 1 1{9}\n"
                    "WIDTH {1}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {1}\nDATA binary\n",
                    options.doubles() ? '8' : '4', points.figures().points, color.fields,
                    color.size, color.type, color.count, has_intensity ? " intensity" : "",
                    has_intensity ? " 4" : "", has_intensity ? " F" : "",
                    has_intensity ? " 1" : "");
}

}  // namespace

ExportFigures write_pcd(const MapReader& map, const std::filesystem::path& path,
                        const PointFileOptions& options) {
  return write_point_file(map, path, options, pcd_header, [](Rgb color, BytePacker& packer) {
    packer.put(color.b);
    packer.put(color.g);
    packer.put(color.r);
    packer.put(std::uint8_t{0});
  });
}

}  // namespace fovea
