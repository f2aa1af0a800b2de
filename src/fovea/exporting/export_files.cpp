#include "fovea/exporting/export_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <span>

#include "fovea/exporting/orthophoto/orthophoto_writer.h"

namespace fovea {

std::string export_format_names() {
  const std::span formats(kExportFormats);
  return fmt::format("{} or {}", fmt::join(formats.first(formats.size() - 1), ", "),
                     formats.back());
}

CommandFiles export_files(const ExportPaths& paths, const std::string& format, bool force) {
  CommandFiles files;
  files.inputs = {paths.map.string()};
  if (!paths.drive.empty()) files.inputs.push_back(paths.drive.string());
  if (format == "orthophoto") {
    const auto [picture, world_file, auxiliary] = orthophoto_files(paths.output);
    files.outputs = {{picture.string(), ContentKind::kPng, force},
                     {world_file.string(), ContentKind::kWorldFile, force},
                     {auxiliary.string(), ContentKind::kRasterAuxiliary, force}};
    return files;
  }
  const std::map<std::string, ContentKind> kinds{
      {"ply", ContentKind::kPly},           {"pcd", ContentKind::kPcd},
      {"las", ContentKind::kLas},           {"glb", ContentKind::kGlb},
      {"frames", ContentKind::kFrameTable}, {"kitti-poses", ContentKind::kPoses},
      {"csv", ContentKind::kFrameTable},    {"tum", ContentKind::kTrajectory},
      {"geojson", ContentKind::kGeoJson}};
  if (const auto kind = kinds.find(format); kind != kinds.end()) {
    files.outputs = {{paths.output.string(), kind->second, force}};
  } else {
    files.folder = {paths.output.string()};
  }
  return files;
}

}  // namespace fovea
