// Recordings of ROS 2 and ROS 1, in any file format.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

/// Files of a recording in their order.
/// @param path  a .bag, .mcap or .db3 file, or a folder with the metadata.yaml that rosbag2 writes
/// InputError for anything else.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

/// Reads such a file, compressed by zstd as a whole (`.db3.zstd`), message by message or not at
/// all. InputError as read_mcap, read_sqlite_bag and read_ros1_bag.
/// @param scratch  folder for what a whole file is decompressed to
void read_bag_file(const std::filesystem::path& file, const std::filesystem::path& scratch,
                   BagSink& sink);

}  // namespace fovea
