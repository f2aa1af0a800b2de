// What people call a file or folder.
#pragma once

#include <filesystem>
#include <string>

namespace fovea {

/// Its own name, also of "." and of "folder/".
std::string name_of(const std::filesystem::path& path);

}  // namespace fovea
