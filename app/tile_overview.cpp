#include "app/tile_overview.h"

#include "fovea/city/city.h"
#include "fovea/core/output_file.h"
#include "fovea/exporting/city/tile_overview.h"

namespace fovea::app {

namespace fs = std::filesystem;

TileFusionFigures fuse_with_overview(const std::vector<fs::path>& maps, const CityPoses& city,
                                     TileFusionJob job) {
  const fs::path output = check_output_path(job.output, job.force);
  job.output = scratch_name(output);
  const TileFusionFigures figures = fuse_tile(maps, city, job);
  std::error_code error;
  try {
    write_tile_overview(job.output, overview_of_tile(output), job.tile_size);
    fs::rename(job.output, output, error);
    if (error) throw_output_error(output, error.value());
  } catch (...) {
    fs::remove(job.output, error);
    throw;
  }
  sync_folder_of(output);
  return figures;
}

}  // namespace fovea::app
