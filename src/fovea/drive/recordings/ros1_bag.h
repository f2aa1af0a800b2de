// Bags of ROS 1, format 2.0 (wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <filesystem>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

/// Reads a file from its beginning to its end, with chunks that are plain or compressed by bz2 or
/// LZ4; the index is not used. A file that ends early (its recorder was killed, or its disk was
/// full) is read up to there, which the sink is told as a loss. InputError for a damaged file and
/// for other formats.
/// @param shown  name of the file in errors
void read_ros1_bag(const std::filesystem::path& file, const std::filesystem::path& shown,
                   BagSink& sink);

}  // namespace fovea
