// Bags of rosbag2's SQLite storage (.db3), what `ros2 bag record` wrote before Iron.
#pragma once

#include <filesystem>
#include <string_view>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

/// Reads a file's messages in the order in which they were recorded. InputError
/// for a file that is damaged or has no topics and messages.
/// @param shown  name of the file in errors
void read_sqlite_bag(const std::filesystem::path& file, const std::filesystem::path& shown,
                     BagSink& sink);

}  // namespace fovea
