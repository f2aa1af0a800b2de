// The files that an export of a map reads and writes.
#pragma once

#include <filesystem>
#include <string>

#include "fovea/drive/command_files.h"

namespace fovea {

struct ExportPaths {
  std::filesystem::path map, output;
  std::filesystem::path drive = {};  ///< whose images are written, too; empty: none
};

/// For check_files(), before an export begins.
/// @param format  an existing one
/// @param force   replaces earlier outputs of this format
CommandFiles export_files(const ExportPaths& paths, const std::string& format, bool force);

}  // namespace fovea
