#include "app/tile_overview.h"

#include "fovea/city/city.h"
#include "fovea/core/output_file.h"
#include "fovea/core/unfinished_output.h"
#include "fovea/exporting/city/tile_overview.h"

namespace fovea::app {

namespace fs = std::filesystem;

TileFusionFigures fuse_with_overview(const std::vector<fs::path>& maps, const CityPoses& city,
                                     TileFusionJob job) {
  const fs::path output = check_output_path(job.output, job.force);
  job.output = output.parent_path() / scratch_name(output);
  const TileFusionFigures figures = fuse_tile(maps, city, job);
  UnfinishedOutput unfinished(output, {job.output}, [] {});
  try {
    write_tile_overview(job.output, overview_of_tile(output), job.tile_size);
    publish_file(job.output, output, unfinished);
  } catch (...) {
    std::error_code ignored;
    fs::remove(job.output, ignored);
    throw;
  }
  return figures;
}

}  // namespace fovea::app
