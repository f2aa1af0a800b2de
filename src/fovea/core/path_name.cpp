#include "fovea/core/path_name.h"

namespace fovea {

std::string name_of(const std::filesystem::path& path) {
  return std::filesystem::absolute(path / "").lexically_normal().parent_path().filename().string();
}

}  // namespace fovea
