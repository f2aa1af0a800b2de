// MCAP files (mcap.dev/spec), what `ros2 bag record` writes since Iron.
#pragma once

#include <filesystem>
#include <string_view>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

/// Reads a file from its beginning to its end, with chunks or without; attachments, indices and
/// meta data are passed over. Topics of encodings that are not read are told to the sink, too.
/// A file that ends early is read up to its last whole record, which the sink is told as a loss.
/// InputError with the place for a file that is damaged, or whose chunks are compressed by anything
/// but zstd and LZ4.
/// @param shown  name of the file in errors
void read_mcap(const std::filesystem::path& file, const std::filesystem::path& shown,
               BagSink& sink);

}  // namespace fovea
