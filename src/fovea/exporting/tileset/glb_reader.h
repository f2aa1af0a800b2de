// Reads back the points of a binary glTF file that make_glb() wrote.
#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "fovea/core/input_file.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea {

/// The points, to half a step of the quantized positions. What the file does not state is unknown.
/// @param where  names the file in errors
/// @throws InputError  if the bytes are no file of make_glb()
std::vector<ExportPoint> read_glb(std::string_view bytes, std::string_view where);

/// The points of a level of detail (make_glb), of the coarsest one if there are fewer levels. All
/// points if the file states no levels.
/// @param level  number of halvings; 0: all points
/// @throws InputError  as above
std::vector<ExportPoint> read_glb_level(std::string_view bytes, std::size_t level,
                                        std::string_view where);
/// Reads no other bytes of the file than these points and the head.
std::vector<ExportPoint> read_glb_level(const InputFile& file, std::size_t level);

/// The bounding cube of the quantized positions. Empty for a file without points.
/// @param bytes  the first ones of the file, kGlbHead or all
/// @throws InputError  as above
Eigen::AlignedBox3d glb_box(std::string_view bytes, std::string_view where);

/// More than the head of such a file has.
inline constexpr std::size_t kGlbHead = 4096;

}  // namespace fovea
