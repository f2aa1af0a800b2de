#include "fovea/map/point_files/cloud_format.h"

#include <cctype>
#include <string>

#include "fovea/core/file_format.h"
#include "fovea/core/input_file.h"
#include "fovea/errors.h"
#include "fovea/map/point_files/las_reader.h"
#include "fovea/map/point_files/pcd_reader.h"
#include "fovea/map/point_files/ply_reader.h"

namespace fovea {

namespace {

/// The readers of clouds and maps report what is wrong with a file of no known format.
std::optional<CloudFormat> format_by_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".ply") return CloudFormat::kPly;
  if (ending == ".pcd") return CloudFormat::kPcd;
  if (ending == ".las") return CloudFormat::kLas;
  if (ending == ".laz") return CloudFormat::kLaz;
  return std::nullopt;
}

}  // namespace

std::optional<CloudFormat> cloud_format(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return format_by_ending(file);
  const SniffedFormat found = sniff_format(InputFile(file, kStreamedFile).beginning(kSniffedBytes));
  switch (found.format) {
    case FileFormat::kPly:
      return CloudFormat::kPly;
    case FileFormat::kPcd:
      return CloudFormat::kPcd;
    case FileFormat::kLas:
      return CloudFormat::kLas;
    case FileFormat::kLaz:
      return CloudFormat::kLaz;
    case FileFormat::kSqlite:
      return std::nullopt;
    case FileFormat::kUnknown:
      return format_by_ending(file);
    default:
      throw InputError("this is " + std::string(found.name) + ", neither a map nor a cloud",
                       file.string(), "give a Fovea map, or a cloud in PLY, PCD or LAS");
  }
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
