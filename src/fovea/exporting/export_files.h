// The files that an export of a map reads and writes.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "fovea/drive/command_files.h"

namespace fovea {

inline constexpr std::array<std::string_view, 14> kExportFormats = {
    "ply",    "pcd",  "las", "3dtiles", "mesh",    "glb",    "orthophoto",
    "colmap", "nerf", "tum", "csv",     "geojson", "frames", "kitti-poses"};

/// For messages: "ply, pcd, ..., frames or kitti-poses".
std::string export_format_names();

struct ExportPaths {
  std::filesystem::path map, output;
  std::filesystem::path drive = {};  ///< whose images are written, too; empty: none
};

/// For check_files(), before an export begins.
/// @param format  an existing one
/// @param force   replaces earlier outputs of this format
CommandFiles export_files(const ExportPaths& paths, const std::string& format, bool force);

}  // namespace fovea
