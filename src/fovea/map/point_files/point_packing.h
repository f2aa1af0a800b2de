// What the formats that store points one behind the other have in common.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "fovea/core/output_file.h"
#include "fovea/map/point_files/byte_packer.h"
#include "fovea/map/point_files/point_file_options.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// x y z as double or float.
inline void pack_position(const ExportPoint& point, bool doubles, BytePacker& packer) {
  for (const double coordinate : point.position) {
    doubles ? packer.put(coordinate) : packer.put(static_cast<float>(coordinate));
  }
}

/// red, green, blue (uint16)
inline void pack_deep_color(const ExportPoint& point, BytePacker& packer) {
  for (const std::uint16_t channel : point.deep_color) packer.put(channel);
}

/// camera (int8), frame (int32), range (float), interpolated, views, spread, reason (uint8).
inline void pack_provenance(const ExportPoint& point, BytePacker& packer) {
  packer.put(point.camera);
  packer.put(point.frame);
  packer.put(point.range);
  packer.put(point.interpolated);
  packer.put(point.views);
  packer.put(point.spread);
  packer.put(point.reason);
}

/// Writes all points with `pack(point, packer)`.
template <class Pack>
void write_points(const PointStream& points, std::ostream& stream, Pack&& pack) {
  std::string bytes;
  points.for_each_block([&](std::span<const ExportPoint> block) {
    bytes.clear();
    BytePacker packer(bytes);
    for (const ExportPoint& point : block) pack(point, packer);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
}

/// Writes a file of a header and all points: position, color, provenance, and the intensity
/// (float) if the map has it. The file appears when it is whole.
/// @param header      the text of `header(points, options, has_intensity)`
/// @param pack_color  packs a color of 8 bits: `pack_color(color, packer)`
template <class Header, class PackColor>
ExportFigures write_point_file(const MapReader& map, const std::filesystem::path& path,
                               const PointFileOptions& options, Header&& header,
                               PackColor&& pack_color) {
  OutputFile file(path, options.force);
  const PointStream points(map, options.points);
  const bool has_intensity = points.has_intensity();
  file.stream() << header(points, options, has_intensity);
  write_points(points, file.stream(), [&](const ExportPoint& point, BytePacker& packer) {
    pack_position(point, options.doubles(), packer);
    if (options.points.deep_colors) {
      pack_deep_color(point, packer);
    } else {
      pack_color(point.color, packer);
    }
    pack_provenance(point, packer);
    if (has_intensity) packer.put(point.intensity);
  });
  file.commit();
  return points.figures();
}

}  // namespace fovea
