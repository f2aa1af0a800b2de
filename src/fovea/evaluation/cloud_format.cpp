#include "fovea/evaluation/cloud_format.h"

#include <cctype>

#include "fovea/evaluation/las_reader.h"
#include "fovea/evaluation/pcd_reader.h"
#include "fovea/evaluation/ply_reader.h"

namespace fovea {

std::optional<CloudFormat> cloud_format(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".ply") return CloudFormat::kPly;
  if (ending == ".pcd") return CloudFormat::kPcd;
  if (ending == ".las") return CloudFormat::kLas;
  if (ending == ".laz") return CloudFormat::kLaz;
  return std::nullopt;
}

CloudFile read_cloud(const std::filesystem::path& file, CloudFormat format,
                     const Eigen::Vector3d& origin) {
  switch (format) {
    case CloudFormat::kPly:
      return read_ply(file, origin);
    case CloudFormat::kPcd:
      return read_pcd(file, origin);
    case CloudFormat::kLas:
      return read_las(file, origin);
    case CloudFormat::kLaz:
      break;
  }
  reject_laz(file);
}

}  // namespace fovea
