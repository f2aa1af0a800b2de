// Recordings of ROS 2, whatever they are stored as.
#pragma once

#include <filesystem>
#include <vector>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

/// Files of a recording in their order.
/// @param path  an .mcap or .db3 file, or a folder with the metadata.yaml that rosbag2 writes
/// InputError for anything else, with a word on recordings of ROS 1.
std::vector<std::filesystem::path> bag_files(const std::filesystem::path& path);

/// Reads such a file, compressed by zstd as a whole (`.db3.zstd`), message by message or not at
/// all. InputError as read_mcap and read_sqlite_bag.
/// @param scratch  folder for what a whole file is decompressed to
void read_bag_file(const std::filesystem::path& file, const std::filesystem::path& scratch,
                   BagSink& sink);

}  // namespace fovea
