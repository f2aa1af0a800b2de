// What a file is, by its content and not by its name.
#pragma once

#include <filesystem>

namespace fovea {

enum class ContentKind {
  kEmpty,
  kMap,
  kMapPair,       ///< JSON of `align`
  kCityPoses,     ///< JSON of `adjust`
  kCatalog,       ///< JSON of `catalog`
  kCityManifest,  ///< JSON of `python3 -m fovea.city`
  kReport,        ///< JSON of `map --report`, `evaluate --json`, `localize --report`, `reproduce`
  kHtml,
  kPly,
  kPcd,
  kLas,
  kGlb,
  kPng,
  kWorldFile,        ///< 6 numbers, one a line: where a picture lies
  kRasterAuxiliary,  ///< XML of GDAL: the CRS of a picture
  kPoses,            ///< 12 numbers a line
  kTrajectory,       ///< 8 numbers a line: TUM
  kGeoJson,
  kPoseTable,   ///< CSV of `localize`
  kFrameTable,  ///< CSV of `export --format frames` and `--format csv`
  kMarkdown,    ///< of `reproduce`
  kSqlite,      ///< a database that is no map
  kJson,        ///< no report of Fovea
  kOther,
};

/// The kind of an existing file; kOther if it cannot be read.
ContentKind content_kind_of(const std::filesystem::path& file);

/// "a Fovea map", "a PLY file", ...
const char* describe(ContentKind kind);

}  // namespace fovea
